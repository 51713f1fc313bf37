#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/experiments/Starts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace viwo::experiments
{
namespace
{
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
/** What is judged after the start (Table 3). */
constexpr double kWindow_s = 30;
/** How long a method may take: the longest that the paper prints is 12.8 s. */
constexpr double kPatience_s = 15;
/** Where a sequence ends soon after the last start, the window may be this short. */
constexpr double kShortestWindow_s = 20;
/** Over the first second after the start: less than this is standstill, or a turn on the spot. */
constexpr double kDriven_m = 0.05;
/** A trajectory converged when it is no worse than this. */
constexpr double kWorstOfLength = 0.05, kWorstScale = 0.10;
/** The scale of a path shorter than this is that of its noise. */
constexpr double kShortestPath_m = 0.5;

enum class Method
{
	ours,
	vins
};

RunRecipe runOf(const std::string& sequence, uint64_t seed, double start_s, Method method)
{
	RunRecipe run(sequenceLog(sequence, seed));
	run.variant = "start" + fixed(start_s, 0);
	if (method == Method::vins)
	{
		run.variant += "-vins";
		run.overrides = {"factors.wheels_in_initialization=false"};
	}
	run.from_s = start_s;
	run.to_s = start_s + kPatience_s + kWindow_s;
	run.cost_s = kVisionCost * (kPatience_s + kWindow_s);
	return run;
}

Trajectory cut(const Trajectory& trajectory, int64_t from_ns, int64_t to_ns)
{
	Trajectory part;
	for (const StampedPose& pose : trajectory.poses())
		if (pose.t_ns >= from_ns && pose.t_ns <= to_ns) part.push_back(pose);
	return part;
}

double seconds(const Json& summary, const char* key)
{
	return summary.at(key).is_number() ? summary.at(key).get<double>() : kNever;
}

/** What a run shows, and its trajectory for the window. */
class Read
{
   public:
	StartRun run;
	Trajectory trajectory;
	int64_t first_frame_ns = 0;

	explicit Read(const Outcome& outcome)
	{
		run.problem = outcome.no_pose || outcome.open ? "" : outcome.error;
		run.first_pose_s = run.aligned_s = run.rmse_m = run.scale = kNever;
		try
		{
			if (!outcome.failed()) read(outcome);
		}
		catch (const std::exception& e)
		{
			run.problem = e.what();
		}
	}

   private:
	void read(const Outcome& outcome)
	{
		const Json summary = outcome.summary();
		run.first_pose_s = seconds(summary, "first_pose_s");
		run.aligned_s = seconds(summary, "initialization_time_s");
		if (std::isnan(run.first_pose_s)) return;
		trajectory = outcome.trajectory();
		first_frame_ns = trajectory.poses().front().t_ns - nanoseconds(run.first_pose_s);
	}
};

/** Error in the window; says whether it converged. */
void judge(Read& read, const Trajectory& truth, double from_s, double to_s)
{
	if (read.trajectory.empty() || std::isnan(from_s)) return;
	const int64_t from_ns = read.first_frame_ns + nanoseconds(from_s), to_ns = read.first_frame_ns + nanoseconds(to_s);
	const Trajectory true_part = cut(truth, from_ns, to_ns), part = cut(read.trajectory, from_ns, to_ns);
	if (true_part.empty() || part.size() < 2) return;
	const double window_s = secondsBetween(true_part.poses().front().t_ns, true_part.poses().back().t_ns);
	EvaluationOptions options;
	const TrajectoryErrors errors = evaluate(true_part, part, options);
	if (window_s < kShortestWindow_s || errors.matched_duration_s < 0.95 * window_s) return;
	options.alignment = AlignmentKind::sim3;
	const double length_m = true_part.length_m();
	read.run.scale = 1 / evaluate(true_part, part, options).alignment.scale;
	const bool scaled = length_m < kShortestPath_m || std::abs(read.run.scale - 1) <= kWorstScale;
	read.run.converged = scaled && errors.ate_xyz_m <= kWorstOfLength * length_m;
	if (read.run.converged) read.run.rmse_m = errors.ate_xyz_m;
}

/** The window of Table 3 is one for both: 30 s from where the slower one has started. A method that has not started has none. */
void judge(Start& start, Read& ours, Read& vins, const Trajectory& truth)
{
	const int64_t begin_ns = truth.poses().front().t_ns + nanoseconds(start.start_s);
	start.driving = cut(truth, begin_ns, begin_ns + nanoseconds(1.0)).length_m() > kDriven_m;
	const double vins_s = vins.run.aligned_s <= kPatience_s ? vins.run.aligned_s : kNever;
	const double own_s = std::isnan(ours.run.aligned_s) ? ours.run.first_pose_s : std::min(ours.run.aligned_s, kPatience_s);
	const double from_s = std::isnan(vins_s) ? own_s : std::max(own_s, vins_s);
	judge(ours, truth, from_s, from_s + kWindow_s);
	if (!std::isnan(vins_s)) judge(vins, truth, from_s, from_s + kWindow_s);
}

/** @param truth read when it is first needed: all starts on a drive have the same. */
Start startOf(const Runner& runner, const std::string& sequence, uint64_t seed, double start_s, std::optional<Trajectory>& truth)
{
	const Outcome own = runner.outcome(runOf(sequence, seed, start_s, Method::ours)),
	              other = runner.outcome(runOf(sequence, seed, start_s, Method::vins));
	Start start{sequence, seed, start_s, true, own.open || other.open, {}, {}};
	Read ours(own), vins(other);
	try
	{
		if (!truth && !start.open) truth = own.truth();
		if (!start.open) judge(start, ours, vins, *truth);
	}
	catch (const Error& e)
	{
		if (ours.run.problem.empty()) ours.run.problem = e.what();
	}
	start.ours = ours.run;
	start.vins = vins.run;
	return start;
}
}  // namespace

void planStarts(Runner& runner, const Request& request)
{
	if (request.tables.count(2) == 0 && request.tables.count(3) == 0) return;
	for (const std::string& sequence : request.sequences)
		for (const uint64_t seed : request.seeds)
			for (const double start_s : paperSequence(sequence).starts_s)
				for (const Method method : {Method::ours, Method::vins}) runner.want(runOf(sequence, seed, start_s, method));
}

std::vector<Start> starts(const Runner& runner, const Request& request)
{
	std::vector<Start> list;
	if (request.tables.count(2) == 0 && request.tables.count(3) == 0) return list;
	for (const std::string& sequence : request.sequences)
		for (const uint64_t seed : request.seeds)
		{
			std::optional<Trajectory> truth;
			for (const double start_s : paperSequence(sequence).starts_s) list.push_back(startOf(runner, sequence, seed, start_s, truth));
		}
	return list;
}
}  // namespace viwo::experiments
