#pragma once

#include "Geodesy.h"
#include "ImuAxes.h"
#include "RosTopicMap.h"

#include <mrpt/math/TTwist2D.h>
#include <mrpt/obs/CObservation.h>
#include <viwo/core/CameraModel.h>
#include <viwo/core/Pose3.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rosbag
{
class MessageInstance;
}
namespace cv
{
class Mat;
}

/** ROS messages of a bag as plain values and MRPT observations; the only files that see ROS' message headers. All throw Error where the
 * bag's definition of a type is not that of this build. */
namespace viwo
{
struct RosHeader
{
	int64_t header_ns = 0;  //!< 0 where the driver did not set it
	int64_t record_ns = 0;  //!< when the recorder received it
	std::string frame;
	std::string child_frame;  //!< of nav_msgs/Odometry
};

/** Of a message of any convertible type or CameraInfo. */
RosHeader readHeader(const rosbag::MessageInstance& message);

/** The stamp of a message: of its header, or, on request or where that is 0, of its recording. */
inline int64_t stampOf(const RosHeader& header, bool record_time)
{
	return record_time || header.header_ns == 0 ? header.record_ns : header.header_ns;
}

ImuSample readImu(const rosbag::MessageInstance& message, int64_t t_ns);

/** Velocity of O in its own axes, of nav_msgs/Odometry or geometry_msgs/TwistStamped.
 *  @param T_SO O in the frame S whose motion the message tells; nothing: S is O. */
mrpt::math::TTwist2D readTwist(const rosbag::MessageInstance& message, const std::optional<Pose3>& T_SO);

/** Of nav_msgs/Odometry or geometry_msgs/PoseStamped: the pose of the child frame; nothing where it is not finite, or the quaternion is
 *  none. */
std::optional<Pose3> readPose(const rosbag::MessageInstance& message);

/** Of a NavSatFix; nothing without a fix. */
std::optional<GeodeticPoint> readFix(const rosbag::MessageInstance& message);

using TransformTaker = std::function<void(const std::string& parent, const std::string& child, const std::optional<Pose3>& T_parent_child)>;
/** Hands all transforms of a tf message (tf2_msgs/TFMessage, or tf/tfMessage, which has the same bytes) on; nothing for one that is not
 *  finite, or whose quaternion is none. */
void readTransforms(const rosbag::MessageInstance& message, const TransformTaker& take);

/** @name Observations @{ */
mrpt::obs::CObservation::Ptr imuObservation(const rosbag::MessageInstance& message, int64_t t_ns, const Pose3& T_OB,
                                            const std::string& label);
/** Of nav_msgs/Odometry or geometry_msgs/TwistStamped; @param T_SO as in readTwist(). A pose that is none becomes NaN. */
mrpt::obs::CObservation::Ptr odometryObservation(const rosbag::MessageInstance& message, int64_t t_ns, const std::optional<Pose3>& T_SO,
                                                 const std::string& label);
mrpt::obs::CObservation::Ptr fixObservation(const rosbag::MessageInstance& message, int64_t t_ns, const Pose3& T_OA,
                                            const std::string& label);
mrpt::obs::CObservation::Ptr scanObservation(const rosbag::MessageInstance& message, int64_t t_ns, const Pose3& T_OL,
                                             const std::string& label);
/** Points without a return (NaN) are left out. @throws Error: x, y, z are not 32-bit floats, damaged. */
mrpt::obs::CObservation::Ptr cloudObservation(const rosbag::MessageInstance& message, int64_t t_ns, const Pose3& T_OS,
                                              const std::string& label);
/** @} */

/** Lens calibration of a CameraInfo for its pictures as they are (binning and region of interest applied); with `rectified` that of P.
 *  @return nothing where it is not calibrated (K is 0). @throws Error: a lens model other than plumb_bob, equidistant or fisheye. */
std::optional<CameraModel> readCameraInfo(const rosbag::MessageInstance& message, bool rectified);

/** Writes pictures into files. */
class RosPictures
{
   public:
	/** File name extension of a message's picture: png for an Image, that of its bytes for a CompressedImage. */
	static std::string extension(const rosbag::MessageInstance& message);

	/** Width and height of a message's picture, 0 of one that cannot be decoded. @throws UnusableTopic: an encoding that is no picture in
	 * grey or colour. */
	static std::pair<int, int> sizeOf(const rosbag::MessageInstance& message);

	/** An Image as PNG (Bayer patterns and YUV 4:2:2 to colour, 16 bit to 8: see notes()), or the bytes of a CompressedImage as they are,
	 *  but for a PNG of 16 bit, which becomes one of 8.
	 *  @return width and height. @throws Error: an encoding that is no picture in grey or colour, damaged data, cannot be written. */
	std::pair<int, int> write(const rosbag::MessageInstance& message, const std::string& path);

	const std::vector<std::string>& notes() const { return notes_; }

   private:
	void to8Bit(cv::Mat& pixels, const std::string& topic);
	int bitsOf16(const std::string& topic, double brightest);
	std::pair<int, int> writeCompressed(const rosbag::MessageInstance& message, const std::string& path);

	std::map<std::string, int> bits_of_topic_;
	std::map<std::string, std::pair<int, int>> compressed_size_;
	std::vector<std::string> notes_;
};
}  // namespace viwo
