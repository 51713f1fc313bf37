#pragma once

#include <viwo/importers/ImportJob.h>

#include <functional>
#include <string>
#include <vector>

namespace viwo
{
/** Which bags are read, and how. */
struct RosBagOptions
{
	/** Read as one recording. ImportJob::folder is not used. */
	std::vector<std::string> bags;
	/** Which topic becomes which label; empty: proposed from the topics that are there. */
	std::string map_path;
	/** Stamps: when the recorder received a message, instead of its header's stamp. */
	bool record_time = false;
	/** Called with ImportResult::mapping before anything is written; with the proposal where an error comes before it is complete. */
	std::function<void(const std::string&)> show_mapping = [](const std::string&) {};
};

/** Whether ROS bags can be read: viwo was built with Debian's librosbag-storage-dev and the message headers. */
bool hasRosBagSupport();

/** ROS 1 bags (format 2.0; chunks plain, bz2 or lz4) as a rawlog.
 *
 *  | message | becomes |
 *  |---|---|
 *  | sensor_msgs/Imu | CObservationIMU, with the orientation quaternion where there is one |
 *  | nav_msgs/Odometry, geometry_msgs/TwistStamped | CObservationOdometry: twist (vx, vy, wz) of O as velocityLocal, pose of O as pose |
 *  | sensor_msgs/JointState | CObservationOdometry: wheel joints to forward speed and yaw rate |
 *  | sensor_msgs/NavSatFix | CObservationGPS (GGA), and X_gps.tum: east-north-up of the first fix |
 *  | sensor_msgs/LaserScan | CObservation2DRangeScan, of a sensor turned to the middle of the sweep |
 *  | sensor_msgs/Image, CompressedImage | CObservationImage in its own file: PNG, or the compressed bytes; CameraInfo gives the lens |
 *  | sensor_msgs/PointCloud2 | CObservationPointCloud |
 *
 *  O is the base frame: that of the map, else the odometry's child frame, else base_link or base_footprint. Twists and poses of another
 * frame are moved to O where tf leads there. Sensor poses are those of tf
 * and tf_static to the header's frame, unless the map gives them. An IMU that neither of them places is levelled by gravity and turned in
 * steps of 90 degrees to agree with the odometry's accelerations. Observations are written in the order of their stamps, sorted within 10
 * s.
 *
 *  @throws Error in one line: a file that is no bag, unindexed, truncated, encrypted, or ROS 2; a topic that is not there; a type that
 * cannot be converted; viwo was built without rosbag.
 */
ImportResult importRosBags(const ImportJob& job, const RosBagOptions& options);
}  // namespace viwo
