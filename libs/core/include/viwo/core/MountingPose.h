#pragma once

#include <viwo/core/Pose3.h>
#include <viwo/core/Scalars.h>

namespace viwo
{
/** T_OS of a sensor S as files have it: place in metres; yaw, pitch and roll in degrees, in MRPT's order (R = Rz Ry Rx). */
inline Pose3 mountingPose(const Eigen::Vector3d& position_m, const Eigen::Vector3d& yaw_pitch_roll_deg)
{
	const auto turn = [&](int i, const Eigen::Vector3d& axis) { return Eigen::AngleAxisd(yaw_pitch_roll_deg[i] * kDegree, axis); };
	const Eigen::Quaterniond R = turn(0, Eigen::Vector3d::UnitZ()) * turn(1, Eigen::Vector3d::UnitY()) * turn(2, Eigen::Vector3d::UnitX());
	return {R.normalized(), position_m};
}
}  // namespace viwo
