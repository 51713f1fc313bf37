#include <viwo/core/Error.h>
#include <viwo/odometry/OdometryOptions.h>

namespace viwo
{
namespace
{
void requireLabel(const RigFile& rig, const MountedSensor& sensor, const std::string& label, const std::string& key)
{
	if (sensor.label != label)
		throw Error(rig.path + ": the rig is that of label " + sensor.label + ", but [rawlog] " + key + " is " + label +
		            "; make them the same");
}

void requirePose(const RigFile& rig, const MountedSensor& camera)
{
	const Pose3 T_OC = camera.pose();
	if (T_OC.p.isZero() && T_OC.R.vec().isZero())
		throw Error(
		    rig.path + ": camera " + camera.label +
		    " has no pose: it would look straight up from the robot's origin; give pose_x, pose_y, pose_z (m), pose_yaw, pose_pitch, "
		    "pose_roll (deg) of its optical axes (forward: -90 0 -90)");
}

void setWhereKnown(double& target, double value)
{
	if (value > 0) target = value;
}
}  // namespace

std::vector<OptionsSection> OdometryOptions::sections()
{
	return {
	    {"rawlog", &rawlog},           {"tracker", &tracker},         {"factors", &estimator.factors},        {"noise", &estimator.noise},
	    {"priors", &estimator.priors}, {"window", &estimator.window}, {"initializer", &estimator.initializer}};
}

void OdometryOptions::use(const RigFile& rig)
{
	if (rig.camera)
	{
		requireLabel(rig, rig.camera->mounting, rawlog.cam_label, "cam_label");
		requirePose(rig, rig.camera->mounting);
		rawlog.camera_time_offset_s = rig.camera->time_offset_s;
	}
	if (rig.imu)
	{
		requireLabel(rig, rig.imu->mounting, rawlog.imu_label, "imu_label");
		auto& noise = estimator.noise;
		setWhereKnown(noise.imu.acc_noise_m_s2_sqrtHz, rig.imu->acc_noise_m_s2_sqrtHz);
		setWhereKnown(noise.imu.gyro_noise_rad_s_sqrtHz, rig.imu->gyro_noise_rad_s_sqrtHz);
		setWhereKnown(noise.imu.acc_walk_m_s3_sqrtHz, rig.imu->acc_walk_m_s3_sqrtHz);
		setWhereKnown(noise.imu.gyro_walk_rad_s2_sqrtHz, rig.imu->gyro_walk_rad_s2_sqrtHz);
	}
	if (rig.wheels)
	{
		requireLabel(rig, rig.wheels->mounting, rawlog.odometry_label, "odometry_label");
		rawlog.left_scale = rig.wheels->left_scale;
		rawlog.right_scale = rig.wheels->right_scale;
		rawlog.calibrated_track_m = rig.wheels->calibrated_track_m;
		rawlog.wheel_time_offset_s = rig.wheels->time_offset_s;
	}
}
}  // namespace viwo
