#pragma once

#include <string>

namespace viwo::testing
{
struct RobotBagOptions
{
	/** Wheels as sensor_msgs/JointState of four joints (and an arm's) instead of nav_msgs/Odometry; of the log's ticks. */
	bool four_wheels = false;
	double ticks_per_revolution = 2578.33;
};

/** A rawlog as the bag that the same robot would have recorded under ROS 1: /camera/image_raw/compressed and /camera/camera_info,
 *  /imu/data, /odom or /joint_states, /scan, and /tf_static with the frames camera, imu and laser on base_link. Stamps are those of the
 * rawlog, messages are received some milliseconds later. Images must be files of their own.
 *  @param truth_tum poses of O, as PoseStamped under /ground_truth; empty: none. */
void writeRobotBag(const std::string& rawlog, const std::string& truth_tum, const std::string& bag_path,
                   const RobotBagOptions& options = {});

/** The map for viwo-import that makes the labels IMU, CAM and ODOMETRY of a bag with four wheels. */
std::string fourWheelMap(double wheel_radius_m, double track_m, bool with_truth);
}  // namespace viwo::testing
