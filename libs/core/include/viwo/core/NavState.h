#pragma once

#include <viwo/core/Pose3.h>

#include <Eigen/Core>
#include <cstdint>

namespace viwo
{
/** State of the body at one time (paper Eq. 14). v_WB is the velocity of B in W, in W's axes. */
struct NavState
{
	int64_t t_ns = 0;
	Pose3 T_WB;
	Eigen::Vector3d v_WB = Eigen::Vector3d::Zero();  //!< m/s
	Eigen::Vector3d b_a = Eigen::Vector3d::Zero();   //!< accelerometer bias, m/s^2
	Eigen::Vector3d b_g = Eigen::Vector3d::Zero();   //!< gyroscope bias, rad/s
};
}  // namespace viwo
