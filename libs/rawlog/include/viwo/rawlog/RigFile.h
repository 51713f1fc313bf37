#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/Options.h>
#include <viwo/core/Pose3.h>

#include <optional>
#include <string>
#include <vector>

namespace mrpt::obs
{
class CObservation;
}

namespace viwo
{
/** The label of a sensor and its pose on the robot (frame O), the keys that `rawlog-edit --sensors-pose` reads. */
struct MountedSensor
{
	std::string label;
	double x_m = 0, y_m = 0, z_m = 0, yaw_deg = 0, pitch_deg = 0, roll_deg = 0;

	Pose3 pose() const;
	void setPose(const Pose3& T_OS);

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("sensorLabel", label, "label of its observations");
		v("pose_x", x_m, "m, in O: x forward, y left, z up from the middle of the wheel axle on the ground");
		v("pose_y", y_m, "m");
		v("pose_z", z_m, "m");
		v("pose_yaw", yaw_deg, "degrees, about z, then pitch about y, then roll about x");
		v("pose_pitch", pitch_deg, "degrees");
		v("pose_roll", roll_deg, "degrees");
	}
};

/** Section [CAMERA_PARAMS]: MRPT's keys, those of the mounting (T_OC, optical axes), and the clock. */
struct RigCamera : Options<RigCamera>
{
	MountedSensor mounting{"CAM"};
	std::vector<double> resolution_px{0, 0};
	double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
	CameraModel::Distortion distortion = CameraModel::Distortion::none;
	std::vector<double> coefficients{0, 0, 0, 0, 0};
	double time_offset_s = 0;

	/** @throws Error naming the key: no size, no focal length, a wrong count of coefficients. */
	CameraModel model() const;
	void setModel(const CameraModel& model);

	template <class Visitor>
	void visit(Visitor& v)
	{
		mounting.visit(v);
		v("resolution", resolution_px, "width and height, pixels");
		v("fx", fx_px, "focal lengths, pixels", 0.0);
		v("fy", fy_px, "pixels", 0.0);
		v("cx", cx_px, "principal point, pixels; pixel centres are at whole numbers");
		v("cy", cy_px, "pixels");
		v.choice("distortion_model", distortion, "of the lens", std::vector<std::string>{"none", "plumb_bob", "kannala_brandt"});
		v("dist", coefficients, "plumb_bob: k1 k2 p1 p2 k3; kannala_brandt: k1 k2 k3 k4");
		v("camera_time_offset_s", time_offset_s, "t_IMU = t_CAM + this", -10.0, 10.0);
	}
};

/** Section [IMU]: T_OB and noise; a noise of 0 is not known, and the estimator's own configuration counts. */
struct RigImu : Options<RigImu>
{
	MountedSensor mounting{"IMU"};
	double acc_noise_m_s2_sqrtHz = 0, gyro_noise_rad_s_sqrtHz = 0, acc_walk_m_s3_sqrtHz = 0, gyro_walk_rad_s2_sqrtHz = 0;

	template <class Visitor>
	void visit(Visitor& v)
	{
		mounting.visit(v);
		v("acc_noise_m_s2_sqrtHz", acc_noise_m_s2_sqrtHz, "accelerometer white noise density; 0: not known", 0.0);
		v("gyro_noise_rad_s_sqrtHz", gyro_noise_rad_s_sqrtHz, "gyroscope white noise density; 0: not known", 0.0);
		v("acc_walk_m_s3_sqrtHz", acc_walk_m_s3_sqrtHz, "accelerometer bias random walk; 0: not known", 0.0);
		v("gyro_walk_rad_s2_sqrtHz", gyro_walk_rad_s2_sqrtHz, "gyroscope bias random walk; 0: not known", 0.0);
	}
};

/** Section [ODOMETRY]: true wheels against those by which the robot computes what it publishes. */
struct RigWheels : Options<RigWheels>
{
	MountedSensor mounting{"ODOMETRY"};
	double left_scale = 1, right_scale = 1;
	double calibrated_track_m = 0;
	double time_offset_s = 0;

	template <class Visitor>
	void visit(Visitor& v)
	{
		mounting.visit(v);
		v("left_scale", left_scale, "true radius of the left wheel against nominal", 0.1, 10.0);
		v("right_scale", right_scale, "true radius of the right wheel against nominal", 0.1, 10.0);
		v("calibrated_track_m", calibrated_track_m, "true distance between the wheels; 0: the nominal one, track_m of [rawlog]", 0.0,
		  100.0);
		v("wheel_time_offset_s", time_offset_s, "t_IMU = t_WHEEL + this", -10.0, 10.0);
	}
};

/** A robot's calibration in a file of its own, rig.ini: beside a rawlog it counts instead of what the rawlog says of its sensors. The same
 * file is valid for `rawlog-edit --camera-params LABEL,rig.ini` and `--sensors-pose rig.ini`, which put it into the rawlog for good.
 */
struct RigFile
{
	std::optional<RigCamera> camera;
	std::optional<RigImu> imu;
	std::optional<RigWheels> wheels;
	std::string path{};  //!< of the file that it was loaded from, for messages

	/** @throws Error: unreadable, a section or key that is not known, no section at all, a camera without focal length. */
	static RigFile load(const std::string& path);
	/** @throws Error when it cannot be written. */
	void save(const std::string& path, const std::string& header) const;

	/** Puts calibration and pose into an observation of one of its labels. */
	void apply(mrpt::obs::CObservation& observation) const;
};
}  // namespace viwo
