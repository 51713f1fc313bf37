#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/Pose3.h>

#include <string>
#include <utility>

namespace viwo
{
/** Camera 0 and where it sits, from KITTI's three calibration files. */
struct KittiCalibration
{
	CameraModel camera;
	Pose3 T_IC;  //!< camera (as the images are: recorded or rectified) in the frame I of the IMU
};

/** @param folder the drive; the files may be in the folder above, as in KITTI's own archives.
 *  @param image_size width, height: of the recorded or of the rectified images.
 *  @throws Error naming the file and its key: missing, wrong count of numbers, an image size that fits neither.
 */
KittiCalibration readKittiCalibration(const std::string& folder, std::pair<int, int> image_size);
}  // namespace viwo
