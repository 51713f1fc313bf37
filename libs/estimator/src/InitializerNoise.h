#pragma once

#include <viwo/core/WheelSample.h>
#include <viwo/estimator/InitializerOptions.h>

#include <Eigen/Core>

namespace viwo
{
/** Of (k_left, k_right, track_m): one draw for the whole window, so that it does not average out over its intervals. */
inline Eigen::Matrix3d wheelIntrinsicsCovariance(const WheelIntrinsics& at, const InitializerOptions& options)
{
	const Eigen::Vector3d sigma(options.wheel_scale_sigma, options.wheel_scale_sigma, options.track_sigma * at.track_m);
	return sigma.cwiseAbs2().asDiagonal();
}
}  // namespace viwo
