#include "GroundTruthSummary.h"
#include "MapFiles.h"
#include "StagedFolder.h"
#include "TrajectoryFiles.h"

#include <mrpt/core/format.h>
#include <viwo/core/Error.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>
#include <viwo/groundtruth/GroundTruthRun.h>

#include <chrono>
#include <ctime>

namespace viwo::gt
{
namespace
{
constexpr double kJump_m = 0.2, kJump_deg = 10;
constexpr double kWindow_s = 1, kMoving_m = 0.1, kLeastStill_s = 3, kLeastStillShare = 0.05;
constexpr double kFinestMap_m = 0.005, kCoarsestMap_m = 1;

void check(const GroundTruthRunOptions& options)
{
	if (options.rawlogs.empty()) throw Error("no rawlog was given");
	if (!(options.resolution_m >= kFinestMap_m && options.resolution_m <= kCoarsestMap_m))
		throw Error("resolution of the map: a number of metres from 0.005 to 1 is wanted (--resolution)");
}

WithoutOdometry compare(const std::vector<FinalPose>& a, const std::vector<FinalPose>& b)
{
	WithoutOdometry result;
	for (size_t i = 0; i < a.size(); ++i)
	{
		const Pose2 d = between(a[i].T, b[i].T);
		result.mean_m += d.p.norm() / static_cast<double>(a.size());
		result.mean_deg += std::abs(d.yaw) / kDegree / static_cast<double>(a.size());
		result.max_m = std::max(result.max_m, d.p.norm());
	}
	return result;
}

/** Slip, a push, a reset: odometry tells of another motion than the scans do. */
void noteContradictions(const Session& session, const Solution& solution, std::vector<std::string>& notes)
{
	size_t count = 0;
	double worst_m = 0, worst_deg = 0;
	for (size_t i = 1; i < solution.poses.size(); ++i)
	{
		const FinalPose &a = solution.poses[i - 1], &b = solution.poses[i];
		const auto &from = session.scans[i - 1].odometry, &to = session.scans[i].odometry;
		if (!from || !to || session.scans[i - 1].odometry_jumps != session.scans[i].odometry_jumps || a.flag == PoseFlag::odometry_only ||
		    b.flag == PoseFlag::odometry_only)
			continue;
		const Pose2 d = between(between(*from, *to), between(a.T, b.T));
		const double metres = d.p.norm(), degrees = std::abs(d.yaw) / kDegree;
		if (metres < kJump_m && degrees < kJump_deg) continue;
		++count;
		worst_m = std::max(worst_m, metres);
		worst_deg = std::max(worst_deg, degrees);
	}
	if (count == 0) return;
	notes.push_back(mrpt::format("odometry jumped %zu times against the scans, by up to %.2f m and %.0f deg: the scans were believed",
	                             count, worst_m, worst_deg));
}

/** Wheels that spin; or what goes along with the robot, and holds the scans where they are. */
void noteStandstill(const Session& session, const Solution& solution, std::vector<std::string>& notes)
{
	double still_s = 0, moving_s = 0;
	for (size_t a = 0, b = 0; a < session.scans.size(); a = b)
	{
		for (b = a + 1; b < session.scans.size() && secondsBetween(session.scans[a].t_ns, session.scans[b].t_ns) < kWindow_s;) ++b;
		if (b >= session.scans.size()) break;
		const auto &from = session.scans[a].odometry, &to = session.scans[b].odometry;
		if (!from || !to || between(*from, *to).p.norm() < kMoving_m) continue;
		const double dt_s = secondsBetween(session.scans[a].t_ns, session.scans[b].t_ns);
		moving_s += dt_s;
		if (between(solution.poses[a].T, solution.poses[b].T).p.norm() < 0.5 * between(*from, *to).p.norm()) still_s += dt_s;
	}
	if (still_s < kLeastStill_s || still_s < kLeastStillShare * moving_s) return;
	notes.push_back(mrpt::format(
	    "for %.0f of %.0f s odometry moved and the scans hardly: wheels that spin, or parts of the robot before the lidar (mask "
	    "them: [scan])",
	    still_s, moving_s));
}

void count(const Session& session, const Solution& solution, GroundTruthRunResult& result)
{
	result.scans = session.scans.size();
	result.key_scans = solution.keys.size();
	result.loops_accepted = solution.loops.accepted;
	result.loops_rejected = solution.loops.rejected;
	result.notes = session.notes;
	noteContradictions(session, solution, result.notes);
	noteStandstill(session, solution, result.notes);
	for (size_t i = 0; i < solution.poses.size(); ++i)
	{
		const FinalPose& pose = solution.poses[i];
		++(pose.flag == PoseFlag::good ? result.good : pose.flag == PoseFlag::degenerate ? result.degenerate : result.odometry_only);
		if (i > 0) result.path_length_m += (pose.T.p - solution.poses[i - 1].T.p).norm();
	}
}
}  // namespace

GroundTruthRunResult runGroundTruth(const GroundTruthRunOptions& options, const GroundTruthRunHooks& hooks)
{
	const auto start = std::chrono::steady_clock::now();
	const std::clock_t cpu_start = std::clock();
	check(options);
	StagedFolder folder(options.output_dir);
	const auto progress = [&](double fraction, const std::string& what)
	{
		if (hooks.progress) hooks.progress(fraction, what);
		return !hooks.interrupted || !hooks.interrupted();
	};
	const Session session = loadSession(options, [&](double f) { return progress(0.1 * f, "reading"); });
	const Solution solution = solve(session, options, progress);
	std::optional<WithoutOdometry> without;
	if (!options.options.graph.odometry_edges)
	{
		GroundTruthRunOptions with = options;
		with.options.graph.odometry_edges = true;
		without = compare(solve(session, with, progress).poses, solution.poses);
	}

	GroundTruthRunResult result;
	count(session, solution, result);
	progress(0.96, "writing");
	const std::string& dir = folder.path();
	writeTrajectory(dir, session, solution.poses);
	writeGraph(dir, session, solution.keys, solution.edges, solution.gyro);
	writeMaps(dir, session, solution.keys, solution.poses, options.resolution_m);
	GroundTruthOptions effective = options.options;
	saveOptions(dir + "/config.ini", effective.sections(), "Effective configuration of viwo-groundtruth");
	result.wall_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	result.cpu_time_s = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
	writeSummary(dir + "/summary.json", options, session, solution, without, result);
	folder.commit("summary.json");
	result.summary_path = options.output_dir + "/summary.json";
	return result;
}
}  // namespace viwo::gt
