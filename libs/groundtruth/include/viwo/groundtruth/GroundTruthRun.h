#pragma once

#include <viwo/groundtruth/GroundTruthOptions.h>

#include <functional>
#include <string>
#include <vector>

namespace viwo::gt
{
/** A loop put in by hand: scan `to` seen from scan `from` (indices among the scans that are used). For tests of robustness. */
struct HandMadeLoop
{
	size_t from = 0, to = 0;
	double x_m = 0, y_m = 0, yaw_rad = 0;
};

/** What a run reads and writes. */
struct GroundTruthRunOptions
{
	std::vector<std::string> rawlogs;  //!< one session, in the order of time
	std::string output_dir;            //!< made if it is not there
	std::string config_path;           //!< for the summary only
	std::string scan_label;            //!< empty: the only one there is
	std::string odometry_label;        //!< empty: ODOMETRY if there is any
	std::string imu_label;             //!< empty: IMU if there is any
	double resolution_m = 0.05;        //!< of the map, 0.005 to 1
	int threads = 1;
	bool holdout = false;     //!< leave every tenth scan out of graph and map, and compare
	bool align_axes = false;  //!< turn the map so that most walls lie along its axes
	bool allow_truncated = false;
	GroundTruthOptions options;
	std::vector<HandMadeLoop> extra_loops;
};

/** Hooks of a run; all may be empty. */
struct GroundTruthRunHooks
{
	/** Fraction done, and a word on what is going on. */
	std::function<void(double fraction, const std::string& note)> progress;
	std::function<void(const std::string& line)> log;
	std::function<bool()> interrupted;
};

/** How a run ended. */
struct GroundTruthRunResult
{
	size_t scans = 0, key_scans = 0, loops_accepted = 0, loops_rejected = 0;
	size_t good = 0, degenerate = 0, odometry_only = 0;
	double path_length_m = 0, cpu_time_s = 0, wall_time_s = 0;
	std::vector<std::string> notes;  //!< what the user should know
	std::string summary_path;
};

/** Rawlogs with scans of a planar lidar, and odometry if there is any, into a folder: trajectory.tum, trajectory_covariance.csv, graph.g2o,
 *  graph_stamps.csv, map.yaml, map.pgm, map.png, map.simplemap, map.gridmap.gz, summary.json, config.ini. Same input, same bytes, whatever
 * the number of threads. The files appear all together at the end; a run that fails leaves the folder as it was.
 *  @throws Error with one line for the user.
 */
GroundTruthRunResult runGroundTruth(const GroundTruthRunOptions& options, const GroundTruthRunHooks& hooks = {});
}  // namespace viwo::gt
