#include "OdometryCalibration.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>

namespace viwo::gt
{
namespace
{
constexpr double kWindow_s = 1.0;
constexpr size_t kFewest = 20;

struct Step
{
	Pose2 scan, odometry;
};

/** Motions over about a second, by the scans and by odometry. */
std::vector<Step> stepsOf(const Session& session, const std::vector<FinalPose>& poses)
{
	std::vector<Step> steps;
	for (size_t a = 0, b = 0; a < poses.size(); a = std::max(a + 1, b))
	{
		b = std::max(b, a + 1);
		while (b < poses.size() && secondsBetween(session.scans[a].t_ns, session.scans[b].t_ns) < kWindow_s) ++b;
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

/** Shift of the odometry's yaw rates that fits those of the scans best: of the derivative of the sum of squares, one Newton step. */
std::optional<double> timeOffset_s(const Session& session, const std::vector<FinalPose>& poses)
{
	double numerator = 0, denominator = 0;
	size_t count = 0;
	for (size_t i = 2; i + 2 < poses.size(); ++i)
	{
		const auto rate = [&](size_t a, size_t b, bool odometry)
		{
			const double turn = odometry ? wrapped(session.scans[b].odometry->yaw - session.scans[a].odometry->yaw)
			                             : wrapped(poses[b].T.yaw - poses[a].T.yaw);
			return turn / secondsBetween(session.scans[a].t_ns, session.scans[b].t_ns);
		};
		bool usable = true;
		for (size_t k = i - 2; k <= i + 2; ++k) usable = usable && session.scans[k].odometry && poses[k].flag == PoseFlag::good;
		if (!usable || secondsBetween(session.scans[i - 2].t_ns, session.scans[i + 2].t_ns) > 2) continue;
		const double dt_s = secondsBetween(session.scans[i - 1].t_ns, session.scans[i + 1].t_ns);
		const double slope = (rate(i, i + 2, true) - rate(i - 2, i, true)) / dt_s;
		const double difference = rate(i - 1, i + 1, false) - rate(i - 1, i + 1, true);
		if (std::abs(slope) < 0.05 || std::abs(difference) > 0.3) continue;
		// scans(t) = odometry(t - offset): the difference is minus the slope times the offset.
		numerator -= slope * difference;
		denominator += slope * slope;
		++count;
	}
	if (count < kFewest) return std::nullopt;
	return numerator / denominator;
}
}  // namespace

OdometryCalibration calibrateOdometry(const Session& session, const std::vector<FinalPose>& poses)
{
	OdometryCalibration calibration;
	std::vector<double> distance, turn, direction;
	for (const Step& step : stepsOf(session, poses))
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
		for (double& ratio : distance) ratio = std::abs(ratio - *calibration.distance_scale);
		calibration.distance_deviation = *median(distance) / 0.6745;
	}
	calibration.turn_scale = median(turn);
	calibration.lidar_yaw_rad = median(direction);
	calibration.time_offset_s = timeOffset_s(session, poses);
	return calibration;
}
}  // namespace viwo::gt
