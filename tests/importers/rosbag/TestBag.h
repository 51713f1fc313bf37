#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <viwo/core/Pose3.h>

#include <cstdint>
#include <string>
#include <vector>

/** Messages for a bag that a test writes. */
namespace viwo::testing
{
constexpr int64_t kBagStart_ns = 1600000000000000000;

/** Milliseconds after the start of the bag. */
inline ros::Time bagTime(int64_t t_ms)
{
	ros::Time time;
	return time.fromNSec(static_cast<uint64_t>(kBagStart_ns + t_ms * 1000000));
}

template <class Message>
Message stampedAt(const ros::Time& time, const std::string& frame)
{
	Message message;
	message.header.stamp = time;
	message.header.frame_id = frame;
	return message;
}

template <class Message>
Message stamped(int64_t t_ms, const std::string& frame)
{
	return stampedAt<Message>(bagTime(t_ms), frame);
}

inline geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child, const Pose3& T)
{
	auto message = stamped<geometry_msgs::TransformStamped>(0, parent);
	message.child_frame_id = child;
	message.transform.translation.x = T.p.x(), message.transform.translation.y = T.p.y(), message.transform.translation.z = T.p.z();
	message.transform.rotation.w = T.R.w(), message.transform.rotation.x = T.R.x();
	message.transform.rotation.y = T.R.y(), message.transform.rotation.z = T.R.z();
	return message;
}

inline sensor_msgs::Imu imuMessage(int64_t t_ms, const Eigen::Vector3d& acc_m_s2, const Eigen::Vector3d& gyro_rad_s)
{
	auto message = stamped<sensor_msgs::Imu>(t_ms, "imu_link");
	message.orientation_covariance[0] = -1;
	message.linear_acceleration.x = acc_m_s2.x(), message.linear_acceleration.y = acc_m_s2.y();
	message.linear_acceleration.z = acc_m_s2.z();
	message.angular_velocity.x = gyro_rad_s.x(), message.angular_velocity.y = gyro_rad_s.y(), message.angular_velocity.z = gyro_rad_s.z();
	return message;
}

inline nav_msgs::Odometry odometryMessage(int64_t t_ms, double v_m_s, double w_rad_s, double x_m = 0, double yaw_rad = 0)
{
	auto message = stamped<nav_msgs::Odometry>(t_ms, "odom");
	message.child_frame_id = "base_link";
	message.twist.twist.linear.x = v_m_s, message.twist.twist.angular.z = w_rad_s;
	message.pose.pose.position.x = x_m;
	message.pose.pose.orientation.w = std::cos(yaw_rad / 2), message.pose.pose.orientation.z = std::sin(yaw_rad / 2);
	return message;
}

/** Pixel (row, column, channel) of picture n. */
inline uint8_t shade(int n, size_t byte)
{
	return static_cast<uint8_t>((7 * byte + 31 * static_cast<size_t>(n)) % 251);
}

inline sensor_msgs::Image imageMessage(int64_t t_ms, const std::string& frame, const std::string& encoding, int n, uint32_t bytes_per_pixel)
{
	auto message = stamped<sensor_msgs::Image>(t_ms, frame);
	message.width = 16, message.height = 12, message.encoding = encoding, message.step = message.width * bytes_per_pixel + 4;
	message.data.resize(message.step * message.height);
	for (size_t i = 0; i < message.data.size(); ++i) message.data[i] = shade(n, i);
	return message;
}

inline sensor_msgs::CameraInfo cameraInfoMessage(const std::string& frame, const std::string& model, const std::vector<double>& D)
{
	auto message = stamped<sensor_msgs::CameraInfo>(0, frame);
	message.width = 16, message.height = 12, message.distortion_model = model, message.D = D;
	message.K = {10, 0, 7.5, 0, 11, 5.5, 0, 0, 1};
	message.P = {9, 0, 7, 0, 0, 9.5, 5, 0, 0, 0, 1, 0};
	return message;
}

/** Some bags hold nothing but odometry. */
inline void writeOdometryBag(const std::string& path, int messages, rosbag::CompressionType compression = rosbag::compression::Uncompressed)
{
	rosbag::Bag bag(path, rosbag::bagmode::Write);
	bag.setCompression(compression);
	bag.setChunkThreshold(4096);
	for (int i = 0; i < messages; ++i) bag.write("/odom", bagTime(50 * i), odometryMessage(50 * i, 0.01 * i, 0.1));
	bag.close();
}
}  // namespace viwo::testing
