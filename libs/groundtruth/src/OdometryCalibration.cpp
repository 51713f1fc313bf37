#include "OdometryCalibration.h"

#include <viwo/core/Ranking.h>
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
constexpr size_t kFewest = 20, kFewestTurns = 6;
constexpr double kLongestStep_s = 0.5, kLargestRate_rad_s = 0.2;
constexpr double kSmoothReadings = 2.5, kLeastSmooth_s = 0.2;
constexpr double kOffsetStep_s = 0.01, kWorstOffset_s = 0.05;
constexpr int kOffsetSteps = 40, kOffsetWidth = 5;
constexpr size_t kBlocks = 10;
constexpr double kLeastOffset_s = 0.005, kFewTurns = 1.5;  // few of the blocks may hold all turns
constexpr double kLeastWalk = 0.003;                       // m per square root of a metre
constexpr double kMedianOfNormal = 0.6745;                 // median of |x|, x standard normal

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

std::optional<double> median(std::vector<double> values, size_t fewest = kFewest)
{
	if (values.size() < fewest) return std::nullopt;
	return upperMedian(values);
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

/** Odometry's yaw rate by a line through the readings around t. Plain interpolation would do harm: it halves the noise between two
 *  readings, so that the best fit would always be half an interval off. @param hint near t, goes along. */
std::optional<double> smoothRate(const std::vector<Rates>& rates, double t_s, double half_width_s, size_t& hint)
{
	while (hint + 1 < rates.size() && rates[hint].t_s < t_s - half_width_s) ++hint;
	while (hint > 0 && rates[hint - 1].t_s >= t_s - half_width_s) --hint;
	double w = 0, wt = 0, wtt = 0, wr = 0, wtr = 0;
	size_t behind = 0, count = 0;
	for (size_t k = hint; k < rates.size() && rates[k].t_s <= t_s + half_width_s; ++k)
	{
		const double t = rates[k].t_s - t_s, weight = 1 - std::abs(t) / half_width_s;
		w += weight;
		wt += weight * t;
		wtt += weight * t * t;
		wr += weight * rates[k].odometry;
		wtr += weight * t * rates[k].odometry;
		behind += t > 0;
		++count;
	}
	const double determinant = w * wtt - wt * wt;
	if (behind == 0 || behind == count || determinant <= 1e-9) return std::nullopt;
	return (wtt * wr - wt * wtr) / determinant;
}

/** Squares of the scans' yaw rates less those that odometry had `offset_s` earlier; single large differences (slip) count little. */
struct Misfit
{
	double sum = 0;
	size_t count = 0;
};

/** Of each of kBlocks stretches of the log. */
std::vector<Misfit> misfits(const std::vector<Rates>& rates, double half_width_s, double offset_s)
{
	std::vector<Misfit> blocks(kBlocks);
	size_t hint = 0;
	for (size_t i = 0; i < rates.size(); ++i)
	{
		const auto odometry = smoothRate(rates, rates[i].t_s - offset_s, half_width_s, hint);
		if (!odometry) continue;
		Misfit& block = blocks[i * kBlocks / rates.size()];
		block.sum += std::min(square(rates[i].scan - *odometry), square(kLargestRate_rad_s));
		++block.count;
	}
	return blocks;
}

double halfWidth_s(const std::vector<Rates>& rates)
{
	std::vector<double> periods;
	for (size_t i = 1; i < rates.size(); ++i) periods.push_back(rates[i].t_s - rates[i - 1].t_s);
	return std::clamp(kSmoothReadings * median(periods).value_or(0), kLeastSmooth_s, kLongestStep_s);
}

/** Misfits of all blocks for each offset, from -kOffsetSteps on. */
using OffsetTable = std::vector<std::vector<Misfit>>;

/** The offset of the best fit, one block left out (kBlocks: none); nothing where the best one is none. */
std::optional<double> bestOffset_s(const OffsetTable& table, size_t left_out)
{
	std::vector<double> mean;
	for (const std::vector<Misfit>& blocks : table)
	{
		Misfit all;
		for (size_t b = 0; b < blocks.size(); ++b)
		{
			if (b == left_out) continue;
			all.sum += blocks[b].sum;
			all.count += blocks[b].count;
		}
		mean.push_back(all.count < kFewest ? std::numeric_limits<double>::infinity() : all.sum / static_cast<double>(all.count));
	}
	int at = 0;
	const auto of = [&mean](int k) { return mean[static_cast<size_t>(k + kOffsetSteps)]; };
	for (int k = -kOffsetSteps; k <= kOffsetSteps; ++k)
		if (of(k) < of(at) || (of(k) == of(at) && std::abs(k) < std::abs(at))) at = k;
	if (!std::isfinite(of(at)) || std::abs(at) + kOffsetWidth > kOffsetSteps) return std::nullopt;
	const double before = of(at - kOffsetWidth), behind = of(at + kOffsetWidth), curvature = before - 2 * of(at) + behind;
	if (!(curvature > 0)) return std::nullopt;
	return at * kOffsetStep_s + 0.5 * kOffsetWidth * kOffsetStep_s * (before - behind) / curvature;
}

/** The shift at which yaw rates by odometry fit those by scans best; nothing where the rates vary too little to tell. Its deviation comes
 *  from what single stretches of the log change (the jackknife of Quenouille and Tukey): errors of neighbouring rates are not independent.
 */
void findTimeOffset(const Session& session, const std::vector<FinalPose>& poses, OdometryCalibration& calibration)
{
	const std::vector<Rates> rates = ratesOf(session, poses);
	const double half_width_s = halfWidth_s(rates);
	OffsetTable table;
	for (int k = -kOffsetSteps; k <= kOffsetSteps; ++k) table.push_back(misfits(rates, half_width_s, k * kOffsetStep_s));
	const auto offset_s = bestOffset_s(table, kBlocks);
	if (!offset_s) return;
	double squares = 0;
	for (size_t block = 0; block < kBlocks; ++block)
	{
		const auto without_s = bestOffset_s(table, block);
		if (!without_s) return;
		squares += square(*without_s - *offset_s);
	}
	const double deviation_s = std::hypot(kFewTurns * std::sqrt(squares * (kBlocks - 1.0) / kBlocks), kLeastOffset_s);
	if (deviation_s > kWorstOffset_s) return;
	calibration.time_offset_s = offset_s;
	calibration.time_offset_deviation_s = deviation_s;
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
	calibration.turn_scale = median(turn, kFewestTurns);
	calibration.lidar_yaw_rad = median(direction);
	calibration.gyro_bias_rad_s = gyroBias_rad_s(session, poses);
	findTimeOffset(session, poses, calibration);
	return calibration;
}
}  // namespace viwo::gt
