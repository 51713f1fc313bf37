#pragma once

#include <viwo/core/Trajectory.h>

#include <functional>
#include <string>
#include <vector>

namespace viwo
{
/** What writeRawlogWithPoses() reads and writes. */
struct RawlogWithPosesOptions
{
	std::string input, output;
	std::string label = "POSE";  //!< of the CObservationRobotPose
	bool allow_truncated = false;
	std::function<void(double fraction)> progress;
	std::function<bool()> interrupted;
};

/** What writeRawlogWithPoses() wrote. */
struct RawlogWithPosesResult
{
	size_t observations = 0, poses = 0;
	size_t left_out = 0;        //!< observations without a stamp, too late, or far from all others: they have no place in the order of time
	std::string images_folder;  //!< of the copy; empty when it needs none
};

/** Copies a rawlog with the trajectory put in as CObservationRobotPose, all in the order of time, so that RawLogViewer and others see both.
 *  Only poses within the rawlog's span go in. External files come along in `<output>_Images/`, as links to the same files where the disk
 *  allows it. The copy is observation-only.
 *  @throws Error: no pose within the span, a label that is taken, output = input, any of reader and writer. There is no rawlog then.
 */
RawlogWithPosesResult writeRawlogWithPoses(const RawlogWithPosesOptions& options, const Trajectory& trajectory);

/** What writeKeyFrameMap() reads and writes. */
struct KeyFrameMapOptions
{
	std::string rawlog, output;
	std::vector<int64_t> key_frames_ns;  //!< rising
	std::vector<std::string> labels;     //!< empty: all images, scans, depth images and clouds
	double max_offset_s = 0.1;           //!< of an observation from its key frame
	double max_gap_s = 1;                //!< of the trajectory
	bool allow_truncated = false;
};

/** MRPT's CSimpleMap: for each key frame its pose and, of each label, the observation nearest in time.
 *  @return key frames in the map. @throws Error when none has pose and observation.
 */
size_t writeKeyFrameMap(const KeyFrameMapOptions& options, const Trajectory& trajectory);

/** Stamps of poses that lie at least `distance_m` or `angle_rad` from the one before. */
std::vector<int64_t> keyFramesAlong(const Trajectory& trajectory, double distance_m, double angle_rad);
}  // namespace viwo
