#include "MotionModel.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>

namespace viwo::gt
{
namespace
{
/** What even a motion of zero leaves open: odometry's own quantisation and the stamps' jitter. */
constexpr double kFloor_m = 0.005, kFloor_rad = 0.15 * kDegree;
constexpr double kLeast_m = 0.001;
}  // namespace

std::optional<Motion2> MotionModel::between(size_t a, size_t b) const
{
	const Scan &sa = session_.scans[a], &sb = session_.scans[b];
	if (!sa.odometry || !sb.odometry) return std::nullopt;
	Motion2 motion;
	motion.T_ab = gt::between(*sa.odometry, *sb.odometry);
	motion.T_ab.p *= calibration_.distance_scale;
	motion.T_ab.yaw *= calibration_.turn_scale;
	const double way_m = motion.T_ab.p.norm(), turn_rad = std::abs(motion.T_ab.yaw);
	double yaw_variance =
	    square(kFloor_rad) + square(options_.angle_per_rad * turn_rad) + square(options_.angle_deg_per_m * kDegree * way_m);
	if (session_.has_imu && sa.gyro_yaw && sb.gyro_yaw)
	{
		const double dt_s = secondsBetween(sa.t_ns, sb.t_ns);
		const auto& bias = calibration_.gyro_bias_rad_s;
		motion.T_ab.yaw = wrapped(*sb.gyro_yaw - *sa.gyro_yaw - bias.value_or(0) * dt_s);
		if (bias) yaw_variance = square(0.02 * kDegree) + square(options_.gyro_deg_per_sqrt_s * kDegree) * dt_s + square(0.01 * turn_rad);
	}
	const double by_turn_m2 = square(options_.distance_per_rad * turn_rad);
	double xy_variance = square(kFloor_m) + square(options_.distance_per_m * way_m) + by_turn_m2;
	if (calibration_.distance_walk)
		xy_variance = std::min(xy_variance, square(kLeast_m) + square(*calibration_.distance_walk) * way_m + by_turn_m2);
	motion.information.diagonal() << 1 / xy_variance, 1 / xy_variance, 1 / yaw_variance;
	return motion;
}

Twist2 MotionModel::twistAt(size_t scan) const
{
	const size_t a = scan > 0 ? scan - 1 : scan, b = std::min(scan + 1, session_.scans.size() - 1);
	const double dt_s = secondsBetween(session_.scans[a].t_ns, session_.scans[b].t_ns);
	const auto motion = between(a, b);
	if (!motion || dt_s < 1e-3 || dt_s > 1) return {};
	// v in the axes of the scan in the middle.
	return {Pose2(0, 0, -0.5 * motion->T_ab.yaw).R() * motion->T_ab.p / dt_s, motion->T_ab.yaw / dt_s};
}
}  // namespace viwo::gt
