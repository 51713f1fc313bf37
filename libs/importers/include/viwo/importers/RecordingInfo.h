#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace viwo
{
enum class SensorRole
{
	camera,
	imu,
	wheels,
	lidar,
	gps,
	truth,
	other
};

/** One sensor's data in a recording. */
struct StreamInfo
{
	std::string name;  //!< label, topic, or file
	std::string type;  //!< class or message type
	SensorRole role = SensorRole::other;
	size_t count = 0;
	size_t backwards = 0;                   //!< stamps before that of the one before; of a rawlog: those beyond the reader's window
	int64_t first_t_ns = 0, last_t_ns = 0;  //!< smallest and largest
	double rate_hz = 0;                     //!< mean; 0 for fewer than two
	double jitter_s = 0;                    //!< 90 % of the intervals are within this of their median
	double largest_gap_s = 0;
	bool calibrated = true;  //!< a camera: whether its lens is known
	std::string remark;      //!< what must be done before it can be used; empty: nothing
};

/** What is inside of a recording. */
struct RecordingInfo
{
	std::string path, kind;  //!< "rawlog", "ROS 1 bag", "CARMEN log", "EuRoC sequence", "KITTI drive"
	std::vector<StreamInfo> streams;
	std::vector<std::string> notes;
};

/** What is inside of a rawlog, ROS 1 bag, CARMEN log, EuRoC or KITTI folder. Every stamp is read, no image is.
 *  @param proceed called with the fraction done.
 *  @throws Error in one line: missing, of no kind that is known, or an error of that kind's reader; stopped by proceed. */
RecordingInfo inspectRecording(const std::string& path, const std::function<bool(double)>& proceed);

/** A table of the streams, and for each use (modes of viwo-odometry, ground truth by lidar) whether it suffices or what is missing. */
std::string describeRecording(const RecordingInfo& info);
}  // namespace viwo
