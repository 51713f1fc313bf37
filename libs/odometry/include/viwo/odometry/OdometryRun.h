#pragma once

#include <viwo/odometry/OdometryOptions.h>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace viwo
{
/** Which frame's pose in W is written. */
enum class PoseFrame
{
	O,  //!< MRPT's vehicle frame: midpoint of the wheel axle on the ground
	B,  //!< IMU body
	C   //!< camera, optical axes
};

/** What a run reads and writes. */
struct OdometryRunOptions
{
	std::vector<std::string> rawlogs;  //!< of one run, in the order of their time; a pipe counts as a file
	std::string output_dir;            //!< made if it is not there
	std::string config_path;           //!< for the summary only
	OdometryOptions odometry;
	std::shared_ptr<const RigFile> rig;  //!< sensors that count instead of the rawlog's; null: the rawlog's
	PoseFrame pose_frame = PoseFrame::O;
	double from_s = 0;  //!< of the log, from its first stamp
	double to_s = std::numeric_limits<double>::infinity();
	double replay_speed = 0;  //!< 1 = by the log's clock; 0 = as fast as it goes
	bool allow_truncated = false;
};

/** How a run ended. */
struct OdometryRunResult
{
	int frames = 0, poses = 0;
	double duration_s = 0;  //!< of the frames
	double path_length_m = 0;
	double wheel_travel_m = 0;  //!< since the first pose; 0 where wheels are not used
	double wall_time_s = 0;
	double largest_lag_s = 0;  //!< how far a replay by the log's clock fell behind it
	std::string final_status;
	bool interrupted = false;
	/** One line on observations that could not be used (not finite, stamps that do not increase, ...); empty if all could. */
	std::string left_out;
	/** One line where the result contradicts the wheels as no robot could; empty if it does not. */
	std::string doubt;
	std::string summary_path;
};

/** Hooks of a run; all may be empty. */
struct OdometryRunHooks
{
	/** Fraction of the log that is done, and a word on what is going on. */
	std::function<void(double fraction, const std::string& note)> progress;
	std::function<void(const std::string& line)> log;
	std::function<bool()> interrupted;
};

/** Rawlogs through viwo::Odometry into a folder: trajectory.tum, trajectory_imu_rate.tum, trajectory_covariance.csv, landmarks.ply,
 * landmark_observations.csv, keyframes.csv, summary.json, config.ini. Files appear under their names when they are whole. An error in
 * mid-log, or an interruption, leaves files that are valid up to there.
 *  @throws Error with one line for the user.
 */
OdometryRunResult runOdometry(const OdometryRunOptions& options, const OdometryRunHooks& hooks = {});
}  // namespace viwo
