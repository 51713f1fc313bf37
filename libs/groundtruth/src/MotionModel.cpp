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
/** Of a step that odometry could not tell and constant velocity stands in for. */
constexpr double kJump_m = 0.3, kJump_rad = 15 * kDegree;
}  // namespace

std::optional<Motion2> MotionModel::between(size_t a, size_t b) const
{
	const Scan &sa = session_.scans[a], &sb = session_.scans[b];
	if (!sa.odometry || !sb.odometry || contradicted(a, b)) return std::nullopt;
	Motion2 motion;
	motion.T_ab = gt::between(*sa.odometry, *sb.odometry);
	motion.T_ab.p *= calibration_.distance_scale;
	motion.T_ab.yaw *= calibration_.turn_scale;
	const double way_m = motion.T_ab.p.norm(), turn_rad = std::abs(motion.T_ab.yaw);
	const double jumps =
	    static_cast<double>(std::max(sa.odometry_jumps, sb.odometry_jumps) - std::min(sa.odometry_jumps, sb.odometry_jumps));
	double yaw_variance = jumps * square(kJump_rad) + square(kFloor_rad) + square(options_.angle_per_rad * turn_rad) +
	                      square(options_.angle_deg_per_m * kDegree * way_m);
	if (session_.has_imu && sa.gyro_yaw && sb.gyro_yaw)
	{
		const auto known = turnByGyro(a, b);
		motion.T_ab.yaw = known ? known->turn_rad : wrapped(*sb.gyro_yaw - *sa.gyro_yaw);
		if (known) yaw_variance = 1 / known->information;
	}
	const double by_turn_m2 = square(options_.distance_per_rad * turn_rad);
	double xy_variance = square(kFloor_m) + square(options_.distance_per_m * way_m) + by_turn_m2;
	if (calibration_.distance_walk)
		xy_variance = std::min(xy_variance, square(kLeast_m) + square(*calibration_.distance_walk) * way_m + by_turn_m2);
	xy_variance += jumps * square(kJump_m);
	motion.information.diagonal() << 1 / xy_variance, 1 / xy_variance, 1 / yaw_variance;
	return motion;
}

std::optional<GyroTurn> MotionModel::turnByGyro(size_t a, size_t b) const
{
	const Scan &sa = session_.scans[a], &sb = session_.scans[b];
	if (!session_.has_imu || !sa.gyro_yaw || !sb.gyro_yaw || !calibration_.gyro_bias_rad_s) return std::nullopt;
	GyroTurn turn;
	turn.dt_s = secondsBetween(sa.t_ns, sb.t_ns);
	turn.turn_rad = wrapped(*sb.gyro_yaw - *sa.gyro_yaw - *calibration_.gyro_bias_rad_s * turn.dt_s);
	turn.information =
	    1 / (square(0.02 * kDegree) + square(options_.gyro_deg_per_sqrt_s * kDegree) * turn.dt_s + square(0.01 * turn.turn_rad));
	return turn;
}

bool MotionModel::contradicted(size_t a, size_t b) const
{
	const auto& steps = calibration_.contradicted;
	const auto first = std::upper_bound(steps.begin(), steps.end(), std::min(a, b));
	return first != steps.end() && *first <= std::max(a, b);
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
