#include "calibration/BatchStates.h"

#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

namespace viwo
{
const std::vector<std::string>& RigOrder::names()
{
	static const std::vector<std::string> names{"left_scale",  "right_scale",  "track",      "imu_x",         "imu_y",       "imu_z",
	                                            "imu_roll",    "imu_pitch",    "imu_yaw",    "camera_x",      "camera_y",    "camera_z",
	                                            "camera_roll", "camera_pitch", "camera_yaw", "camera_offset", "wheel_offset"};
	return names;
}

namespace
{
/** Of the camera against the IMU, along the robot's axes. */
Eigen::Vector3d cameraLever(const SensorRig& rig)
{
	return rig.T_BO.R.conjugate() * rig.T_BC.p;
}
}  // namespace

RigVector rigDifference(const SensorRig& a, const SensorRig& b)
{
	const Eigen::Quaterniond R_OC = b.T_BO.R.conjugate() * b.T_BC.R;
	RigVector d;
	d << a.wheels.k_left - b.wheels.k_left, a.wheels.k_right - b.wheels.k_right, a.wheels.track_m - b.wheels.track_m,
	    a.T_BO.inverse().p - b.T_BO.inverse().p, so3::log(Eigen::Quaterniond(b.T_BO.R.conjugate() * a.T_BO.R)),
	    cameraLever(a) - cameraLever(b), R_OC * so3::log(Eigen::Quaterniond(b.T_BC.R.conjugate() * a.T_BC.R)),
	    a.camera_offset_s - b.camera_offset_s, a.wheel_offset_s - b.wheel_offset_s;
	return d;
}

SensorRig rigPlus(const SensorRig& b, const RigVector& d)
{
	const Eigen::Quaterniond R_OC = b.T_BO.R.conjugate() * b.T_BC.R;
	SensorRig a;
	a.wheels = {b.wheels.k_left + d[RigOrder::left_scale], b.wheels.k_right + d[RigOrder::right_scale],
	            b.wheels.track_m + d[RigOrder::track]};
	a.T_BO.R = (b.T_BO.R * so3::expQuaternion(d.segment<3>(RigOrder::imu_rotation))).normalized();
	a.T_BO.p = -(a.T_BO.R * (b.T_BO.inverse().p + d.segment<3>(RigOrder::imu_lever)));
	a.T_BC.R = (b.T_BC.R * so3::expQuaternion(R_OC.conjugate() * d.segment<3>(RigOrder::camera_rotation))).normalized();
	a.T_BC.p = a.T_BO.R * (cameraLever(b) + d.segment<3>(RigOrder::camera_lever));
	a.camera_offset_s = b.camera_offset_s + d[RigOrder::camera_offset];
	a.wheel_offset_s = b.wheel_offset_s + d[RigOrder::wheel_offset];
	return a;
}

Eigen::Matrix<double, 6, 6> imuMountingJacobian(const Pose3& T_BO)
{
	const Pose3 T_OB = T_BO.inverse();
	Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Identity();
	J.topLeftCorner<3, 3>() = -T_OB.R.toRotationMatrix();
	J.topRightCorner<3, 3>() = so3::skew(T_OB.p);
	return J;
}

RigJacobian rigJacobian(const SensorRig& rig)
{
	const Eigen::Matrix3d R_OB = rig.T_BO.R.conjugate().toRotationMatrix();
	RigJacobian J = RigJacobian::Identity();
	J.block<6, 6>(RigOrder::imu_lever, RigOrder::imu_lever) = imuMountingJacobian(rig.T_BO);
	J.block<3, 3>(RigOrder::camera_lever, RigOrder::imu_rotation) = so3::skew(cameraLever(rig));
	J.block<3, 3>(RigOrder::camera_lever, RigOrder::camera_lever) = R_OB;
	J.block<3, 3>(RigOrder::camera_rotation, RigOrder::camera_rotation) = R_OB * rig.T_BC.R.toRotationMatrix();
	return J;
}

ImuSample ImuSensitivity::corrected(const ImuSample& measured) const
{
	using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
	const Eigen::Map<const RowMajor3> S_acc(entries.data()), S_gyro(entries.data() + 9);
	return {measured.t_ns, measured.acc_m_s2 - S_acc * measured.acc_m_s2, measured.gyro_rad_s - S_gyro * measured.gyro_rad_s};
}

SensorRig BatchStates::rig() const
{
	return {
	    poseFromBlock(T_BO.data()), poseFromBlock(T_BC.data()), {wheels[0], wheels[1], wheels[2]}, camera_offset_s[0], wheel_offset_s[0]};
}

void BatchStates::setRig(const SensorRig& rig)
{
	poseToBlock(rig.T_BO, T_BO.data());
	poseToBlock(rig.T_BC, T_BC.data());
	wheels = {rig.wheels.k_left, rig.wheels.k_right, rig.wheels.track_m};
	camera_offset_s[0] = rig.camera_offset_s;
	wheel_offset_s[0] = rig.wheel_offset_s;
}

int64_t BatchStates::imuTime_ns(const Frame& frame) const
{
	return frame.t_ns + nanoseconds(camera_offset_s[0]);
}

int64_t BatchStates::wheelTime_ns(const Frame& frame) const
{
	return frame.t_ns + nanoseconds(camera_offset_s[0] - wheel_offset_s[0]);
}
}  // namespace viwo
