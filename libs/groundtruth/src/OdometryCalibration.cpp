#include "OdometryCalibration.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace viwo::gt
{
namespace
{
constexpr double kWindow_s = 1.0, kLongWindow_s = 4.0;
constexpr size_t kFewest = 20;
constexpr double kLongestStep_s = 0.5, kLargestRate_rad_s = 0.2;
constexpr double kOffsetStep_s = 0.01, kWorstOffset_s = 0.02;
constexpr int kOffsetSteps = 40, kOffsetWidth = 5;
constexpr double kLeastWalk = 0.003;        // m per square root of a metre
constexpr double kMedianOfNormal = 0.6745;  // median of |x|, x standard normal

struct Step
{
	Pose2 scan, odometry;
};

/** Motions over a while, by the scans and by odometry. */
std::vector<Step> stepsOf(const Session& session, const std::vector<FinalPose>& poses, double window_s)
{
	std::vector<Step> steps;
	for (size_t a = 0, b = 0; a < poses.size(); a = std::max(a + 1, b))
	{
		b = std::max(b, a + 1);
		while (b < poses.size() && secondsBetween(session.scans[a].t_ns, session.scans[b].t_ns) < window_s) ++b;
		if (b >= poses.size()) break;
		if (!session.scans[a].odometry || !session.scans[b].odometry) continue;
		if (poses[a].flag != PoseFlag::good || poses[b].flag != PoseFlag::good) continue;
		steps.push_back({between(poses[a].T, poses[b].T), between(*session.scans[a].odometry, *session.scans[b].odometry)});
	}
	return steps;
}

std::optional<double> median(std::vector<double> values)
{
	if (values.size() < kFewest) return std::nullopt;
	const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
	std::nth_element(values.begin(), middle, values.end());
	return *middle;
}

/** How far ways by scans and by odometry differ, and how long the ways are. */
struct Spread
{
	double variance_m2 = 0, way_m = 0;
};

std::optional<Spread> spreadOf(const std::vector<Step>& steps, double distance_scale)
{
	std::vector<double> differences, ways;
	for (const Step& step : steps)
	{
		const double way = step.odometry.p.norm();
		if (way < 0.05 || std::abs(step.odometry.yaw) > 20 * kDegree) continue;
		differences.push_back(std::abs(step.scan.p.norm() - distance_scale * way));
		ways.push_back(way);
	}
	const auto difference = median(differences), way = median(ways);
	if (!difference) return std::nullopt;
	return Spread{square(*difference / kMedianOfNormal), *way};
}

/** What grows with the way is odometry's, the rest that of the scans. */
std::optional<double> distanceWalk(const Session& session, const std::vector<FinalPose>& poses, double distance_scale)
{
	const auto brief = spreadOf(stepsOf(session, poses, kWindow_s), distance_scale);
	const auto lengthy = spreadOf(stepsOf(session, poses, kLongWindow_s), distance_scale);
	if (!brief) return std::nullopt;
	double walk2 = brief->variance_m2 / brief->way_m;
	if (lengthy && lengthy->way_m > 1.5 * brief->way_m)
		walk2 = (lengthy->variance_m2 - brief->variance_m2) / (lengthy->way_m - brief->way_m);
	return std::sqrt(std::max(walk2, square(kLeastWalk)));
}

/** Turns by the gyroscope against those by scans, which a corridor tells as well as a room: odometry's own would put the error of its
 *  left and right wheel into the bias. */
std::optional<double> gyroBias_rad_s(const Session& session, const std::vector<FinalPose>& poses)
{
	std::vector<double> rates;
	for (size_t a = 0, b = 0; a < poses.size(); a = std::max(a + 1, b))
	{
		while (b < poses.size() && secondsBetween(session.scans[a].t_ns, session.scans[b].t_ns) < kWindow_s) ++b;
		if (b >= poses.size()) break;
		const Scan &from = session.scans[a], &to = session.scans[b];
		if (!from.gyro_yaw || !to.gyro_yaw || poses[a].flag == PoseFlag::odometry_only || poses[b].flag == PoseFlag::odometry_only)
			continue;
		const double turn = wrapped(poses[b].T.yaw - poses[a].T.yaw);
		rates.push_back(wrapped(*to.gyro_yaw - *from.gyro_yaw - turn) / secondsBetween(from.t_ns, to.t_ns));
	}
	return median(rates);
}

/** Yaw rates at one time. */
struct Rates
{
	double t_s, scan, odometry;
};

std::vector<Rates> ratesOf(const Session& session, const std::vector<FinalPose>& poses)
{
	std::vector<Rates> rates;
	for (size_t i = 1; i + 1 < poses.size(); ++i)
	{
		const Scan &a = session.scans[i - 1], &b = session.scans[i + 1];
		const double dt_s = secondsBetween(a.t_ns, b.t_ns);
		const bool good = poses[i - 1].flag != PoseFlag::odometry_only && poses[i + 1].flag != PoseFlag::odometry_only;
		if (!a.odometry || !b.odometry || !good || dt_s > kLongestStep_s) continue;
		const double t_s = secondsBetween(session.scans[0].t_ns, a.t_ns) + 0.5 * dt_s;
		rates.push_back({t_s, wrapped(poses[i + 1].T.yaw - poses[i - 1].T.yaw) / dt_s, wrapped(b.odometry->yaw - a.odometry->yaw) / dt_s});
	}
	return rates;
}

/** Mean square of the scans' yaw rates less those that odometry had `offset_s` earlier; single large differences (slip) count little. */
double misfit(const std::vector<Rates>& rates, double offset_s)
{
	double sum = 0;
	size_t count = 0, k = 0;
	for (const Rates& r : rates)
	{
		while (k + 1 < rates.size() && rates[k + 1].t_s < r.t_s - offset_s) ++k;
		while (k > 0 && rates[k].t_s > r.t_s - offset_s) --k;
		if (k + 1 >= rates.size() || rates[k].t_s > r.t_s - offset_s) continue;
		const Rates &a = rates[k], &b = rates[k + 1];
		if (b.t_s - a.t_s > kLongestStep_s) continue;
		const double odometry = a.odometry + (r.t_s - offset_s - a.t_s) / (b.t_s - a.t_s) * (b.odometry - a.odometry);
		sum += std::min(square(r.scan - odometry), square(kLargestRate_rad_s));
		++count;
	}
	return count < kFewest ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(count);
}

/** The shift at which yaw rates by odometry fit those by scans best; nothing where the rates vary too little to tell. */
std::optional<double> timeOffset_s(const Session& session, const std::vector<FinalPose>& poses)
{
	const std::vector<Rates> rates = ratesOf(session, poses);
	double best = std::numeric_limits<double>::infinity();
	int at = 0;
	for (int k = -kOffsetSteps; k <= kOffsetSteps; ++k)
	{
		const double value = misfit(rates, k * kOffsetStep_s);
		if (value < best || (value == best && std::abs(k) < std::abs(at)))
		{
			best = value;
			at = k;
		}
	}
	if (!std::isfinite(best) || std::abs(at) == kOffsetSteps) return std::nullopt;
	const double before = misfit(rates, (at - kOffsetWidth) * kOffsetStep_s), behind = misfit(rates, (at + kOffsetWidth) * kOffsetStep_s);
	const double curvature = before - 2 * best + behind, h_s = kOffsetWidth * kOffsetStep_s;
	// Deviation of the minimum of a parabola through sums of that many squares.
	const double deviation_s = h_s * std::sqrt(best / (0.5 * static_cast<double>(rates.size()) * curvature));
	if (!(curvature > 0) || !(deviation_s < kWorstOffset_s)) return std::nullopt;
	return at * kOffsetStep_s + 0.5 * h_s * (before - behind) / curvature;
}
}  // namespace

OdometryCalibration calibrateOdometry(const Session& session, const std::vector<FinalPose>& poses)
{
	OdometryCalibration calibration;
	std::vector<double> distance, turn, direction;
	for (const Step& step : stepsOf(session, poses, kWindow_s))
	{
		const double way = step.odometry.p.norm(), yaw = step.odometry.yaw;
		if (way > 0.05 && std::abs(yaw) < 5 * kDegree) distance.push_back(step.scan.p.norm() / way);
		if (std::abs(yaw) > 10 * kDegree) turn.push_back(step.scan.yaw / yaw);
		// Straight ahead O moves along its x axis; a lidar that is turned to the left makes the motion look turned to the right.
		if (way > 0.1 && std::abs(yaw) < 2 * kDegree && step.odometry.p.x() > 0)
			direction.push_back(-wrapped(std::atan2(step.scan.p.y(), step.scan.p.x()) - 0.5 * step.scan.yaw));
	}
	calibration.distance_scale = median(distance);
	if (calibration.distance_scale)
	{
		calibration.distance_walk = distanceWalk(session, poses, *calibration.distance_scale);
		for (double& ratio : distance) ratio = std::abs(ratio - *calibration.distance_scale);
		// Of a median, from the median of the deviations.
		calibration.distance_scale_deviation =
		    1.2533 * *median(distance) / kMedianOfNormal / std::sqrt(static_cast<double>(distance.size()));
	}
	calibration.turn_scale = median(turn);
	calibration.lidar_yaw_rad = median(direction);
	calibration.gyro_bias_rad_s = gyroBias_rad_s(session, poses);
	calibration.time_offset_s = timeOffset_s(session, poses);
	return calibration;
}
}  // namespace viwo::gt
