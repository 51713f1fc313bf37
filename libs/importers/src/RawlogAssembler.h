#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/ImuSample.h>
#include <viwo/core/Pose3.h>
#include <viwo/core/Trajectory.h>
#include <viwo/core/WheelSample.h>
#include <viwo/importers/ImportJob.h>

#include <cstdint>
#include <string>
#include <vector>

namespace viwo
{
struct ImageFile
{
	int64_t t_ns = 0;
	std::string path;
};

struct TwistSample
{
	int64_t t_ns = 0;
	WheelTwist twist;
};

/** A recording in memory, images still in their files. */
struct Recording
{
	CameraModel camera;
	Pose3 T_OC, T_OB;
	std::vector<ImageFile> images;
	std::vector<ImuSample> imu;
	std::vector<TwistSample> odometry;
	Trajectory ground_truth;  //!< of O; may be empty
};

/** Writes rawlog, image folder and ground truth; observations in the order of their stamps.
 *  The pose that odometry observations carry is the twists' integral, trapezoidal.
 *  @throws Error: an image that is missing or (the first) of another size than the camera's; anything that cannot be written; stopped by
 * job.proceed.
 */
ImportResult writeRecording(const Recording& recording, const ImportJob& job);

/** Width and height in pixels. @throws Error when it is missing or not an image. */
std::pair<int, int> imageSize(const std::string& path);
}  // namespace viwo
