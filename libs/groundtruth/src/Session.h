#pragma once

#include <viwo/core/Pose3.h>
#include <viwo/groundtruth/GroundTruthRun.h>
#include <viwo/groundtruth/Pose2.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace viwo::gt
{
/** One sweep; invalid beams, and those that [scan] leaves out, have range 0. */
struct Scan
{
	int64_t t_ns = 0;
	std::vector<float> ranges_m;  //!< counter-clockwise
	double first_angle_rad = 0, step_rad = 0;
	float max_range_m = 0;
	Pose3 T_OL;
	std::optional<Pose2> odometry;   //!< of O at t_ns; nothing where no odometry reading is near
	size_t odometry_jumps = 0;       //!< steps up to here that odometry could not tell
	std::optional<double> gyro_yaw;  //!< integrated yaw rate up to t_ns, rad; only differences mean anything
};

/** What the rawlogs hold, in the order of time. */
struct Session
{
	std::vector<Scan> scans;
	std::string scan_label;
	bool has_odometry = false, has_imu = false;
	size_t odometry_jumps = 0, odometry_left_out = 0;
	double gyro_bias_rad_s = 0;      //!< that was taken off
	double range_noise_m = 0;        //!< of single beams, from the data
	std::vector<std::string> notes;  //!< one line each: what was left out, and why
};

/** @throws Error naming file and remedy: unreadable, no scans, several scan labels and none chosen, a label that was asked for is not
 * there. */
Session loadSession(const GroundTruthRunOptions& options, const std::function<bool(double)>& proceed);
}  // namespace viwo::gt
