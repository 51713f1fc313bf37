#include "Groups.h"

#include <viwo/core/Time.h>

#include <algorithm>
#include <utility>

#include "Measure.h"

namespace viwo::accuracy
{
namespace
{
/** Alone, for the sake of its frame times. */
RunRecipe standingRun()
{
	RunRecipe run{SimulatedDrive{"standing", "corridor", "standing", {"lidar.enabled=false"}}.log(1)};
	run.alone = true;
	return run;
}

/** The longest time in which the truth does not move. */
std::pair<int64_t, int64_t> longestStandstill(const Trajectory& truth)
{
	const double still_m = 1e-9;
	std::pair<int64_t, int64_t> longest{0, 0};
	const auto& poses = truth.poses();
	for (size_t begin = 0; begin < poses.size();)
	{
		size_t end = begin;
		while (end + 1 < poses.size() && (poses[end + 1].T.p - poses[begin].T.p).norm() < still_m) ++end;
		if (poses[end].t_ns - poses[begin].t_ns > longest.second - longest.first) longest = {poses[begin].t_ns, poses[end].t_ns};
		begin = end + 1;
	}
	return longest;
}

/** Largest distance and angle from the first pose of the standstill. */
std::pair<double, double> movement(const Outcome& outcome)
{
	const auto [begin_ns, end_ns] = longestStandstill(outcome.truth());
	const StampedPose* first = nullptr;
	std::pair<double, double> m{0, 0};
	const Trajectory trajectory = outcome.trajectory();
	for (const StampedPose& pose : trajectory.poses())
	{
		if (pose.t_ns < begin_ns || pose.t_ns > end_ns) continue;
		if (first == nullptr) first = &pose;
		m.first = std::max(m.first, (pose.T.p - first->T.p).norm());
		m.second = std::max(m.second, pose.T.R.angularDistance(first->T.R) * 180 / M_PI);
	}
	if (first == nullptr || secondsBetween(first->t_ns, end_ns) < 590) return {NAN, NAN};
	return m;
}

class Standing : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Standing::bars() const
{
	return {"standing 10 minutes: distance moved", "standing 10 minutes: angle turned",
	        "standing 10 minutes: frame time, last minute over first"};
}

void Standing::plan(Runner& runner) const
{
	runner.want(standingRun());
}

std::vector<Row> Standing::judge(const Runner& runner) const
{
	const Outcome outcome = runner.outcome(standingRun());
	if (outcome.failed()) throw Error(outcome.error);
	const auto [distance_m, angle_deg] = movement(outcome);
	const Score score = scoreOf(outcome);
	const Json minutes = outcome.summary().at("minutes");
	std::vector<double> medians;
	for (const Json& minute : minutes) medians.push_back(minute.at("frame_median_ms").get<double>());
	// The drives before and after take 20 s each: minutes 1 to 9 are of standing alone.
	const std::string ate = "ATE of the whole run " + std::to_string(100 * score.ate_m) + " cm";
	return {atMost(bars()[0], 100 * distance_m, 1, "cm", ate), atMost(bars()[1], angle_deg, 0.2, "deg", ""),
	        atMost(bars()[2], medians.at(9) / medians.at(1), 1.2, "", listOf("median of each minute", medians, 1, "ms"))};
}
}  // namespace

std::unique_ptr<Group> standing(const Settings& settings)
{
	return std::make_unique<Standing>(settings);
}
}  // namespace viwo::accuracy
