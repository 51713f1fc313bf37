#pragma once

#include "TestBag.h"

#include <cstring>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

/** Bags with messages of every type that can be imported. */
namespace viwo::testing
{
inline const Pose3 kT_OB(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX())), Eigen::Vector3d(0.1, 0, 0.3));
inline const Pose3 kT_OC(forwardOpticalAxes(), Eigen::Vector3d(0.3, 0.05, 0.25));
inline const Pose3 kT_OL(Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(0.2, 0, 0.15));

/** Two seconds of what most robots record; messages of IMU and odometry are recorded 40 ms late and in pairs that are swapped. */
inline void writeUsualTypes(rosbag::Bag& bag)
{
	tf2_msgs::TFMessage frames;
	frames.transforms = {
	    transform("base_link", "imu_link", kT_OB), transform("base_link", "mast", {kT_OC.R, {0, 0.05, 0}}),
	    transform("/mast", "/cam0", {Eigen::Quaterniond::Identity(), kT_OC.R.conjugate() * Eigen::Vector3d(0.3, 0, 0.25)})};
	bag.write("/tf_static", bagTime(0), frames);
	tf2_msgs::TFMessage moving;
	moving.transforms = {transform("odom", "base_link", {}), transform("base_link", "laser", kT_OL)};
	bag.write("/tf", bagTime(1), moving);
	bag.write("/cam0/camera_info", bagTime(2), cameraInfoMessage("cam0", "plumb_bob", {-0.3, 0.1, 1e-3, 2e-3, 0.01}));
	bag.write("/cam1/camera_info", bagTime(2), cameraInfoMessage("cam1", "equidistant", {0.1, 0.02, -0.01, 1e-3}));
	for (int i = 0; i < 100; ++i)
	{
		const int swapped_ms = 20 * (i ^ 1);
		bag.write("/imu", bagTime(20 * i + 40), imuMessage(swapped_ms, {0.1, 9.8, 0.01 * (i ^ 1)}, {0.1, 0.2, 0.3 + i}));
	}
	for (int i = 0; i < 40; ++i) bag.write("/odom", bagTime(50 * i + 3), odometryMessage(50 * i, 0.5, 0.1 * i, 0.025 * i, 0.01 * i));
	for (int i = 0; i < 10; ++i)
	{
		bag.write("/cam0/image_raw", bagTime(200 * i + 30),
		          imageMessage(200 * i, "cam0", i % 2 == 0 ? "mono8" : "rgb8", i, i % 2 == 0 ? 1 : 3));
		auto picture = stamped<sensor_msgs::CompressedImage>(200 * i + 1, "cam1");
		cv::imencode(".jpg", cv::Mat(12, 16, CV_8U, cv::Scalar(10 * i)), picture.data);
		bag.write("/cam1/image_raw/compressed", bagTime(200 * i + 31), picture);
		auto scan = stamped<sensor_msgs::LaserScan>(200 * i + 5, "laser");
		scan.angle_min = -1.5f, scan.angle_increment = 0.5f, scan.angle_max = 1.0f, scan.range_min = 0.1f, scan.range_max = 20;
		scan.ranges = {1, 0.05f, 3, 25, std::numeric_limits<float>::quiet_NaN(), 6.0f + static_cast<float>(i)};
		bag.write("/scan", bagTime(200 * i + 20), scan);
		auto fix = stamped<sensor_msgs::NavSatFix>(200 * i + 7, "gps");
		fix.latitude = 1e-5 * i, fix.longitude = 0, fix.altitude = 5, fix.status.status = static_cast<int8_t>(i == 3 ? -1 : 0);
		bag.write("/fix", bagTime(200 * i + 25), fix);
		auto pose = stamped<geometry_msgs::PoseStamped>(200 * i, "world");
		pose.pose.position.x = 0.1 * i, pose.pose.orientation.w = 1;
		bag.write("/vicon", bagTime(200 * i + 1), pose);
	}
}

inline void writeFullBag(const std::string& path)
{
	rosbag::Bag bag(path, rosbag::bagmode::Write);
	writeUsualTypes(bag);
	bag.close();
}

/** Rates (rad/s) of the wheels front left, rear left, front right, rear right. */
inline const std::vector<double> kWheelRates_rad_s{2, 4, 6, 8};

inline sensor_msgs::JointState wheelsMessage(int64_t t_ms)
{
	auto state = stamped<sensor_msgs::JointState>(t_ms, "");
	state.name = {"fl", "rl", "fr", "rr"};
	for (const double rate : kWheelRates_rad_s) state.position.push_back(1e-3 * static_cast<double>(t_ms) * rate);
	return state;
}

inline sensor_msgs::PointCloud2 cloudMessage(int64_t t_ms, const std::string& frame, const std::vector<Eigen::Vector3f>& points)
{
	auto cloud = stamped<sensor_msgs::PointCloud2>(t_ms, frame);
	for (const char* name : {"x", "y", "z"})
	{
		sensor_msgs::PointField field;
		field.name = name, field.offset = static_cast<uint32_t>(4 * cloud.fields.size());
		field.datatype = sensor_msgs::PointField::FLOAT32, field.count = 1;
		cloud.fields.push_back(field);
	}
	cloud.width = static_cast<uint32_t>(points.size()), cloud.height = 1, cloud.point_step = 16, cloud.row_step = 16 * cloud.width;
	cloud.data.resize(cloud.row_step);
	for (size_t i = 0; i < points.size(); ++i) std::memcpy(&cloud.data[16 * i], points[i].data(), 12);
	return cloud;
}

/** Two more seconds' worth: wheels as joints and as a twist, point clouds, and pictures of other encodings; each stream in swapped pairs.
 */
inline void writeOtherTypes(rosbag::Bag& bag)
{
	for (int k = 0; k < 20; ++k)
	{
		const int i = k ^ 1;
		auto twist = stamped<geometry_msgs::TwistStamped>(100 * i + 11, "base_link");
		twist.twist.linear.x = 0.01 * i, twist.twist.angular.z = -0.02 * i;
		bag.write("/vehicle/twist", bagTime(100 * k + 15), twist);
		bag.write("/joint_states", bagTime(100 * k + 16), wheelsMessage(100 * k));
	}
	for (int k = 0; k < 10; ++k)
	{
		const int i = k ^ 1;
		const float f = static_cast<float>(i);
		bag.write("/points", bagTime(200 * k + 60), cloudMessage(200 * i + 9, "laser", {{f, 1, 2}, {3, f, 4}, {5, 6, f}}));
		bag.write("/bgr/image_raw", bagTime(200 * k + 61), imageMessage(200 * i + 2, "cam0", "bgr8", i, 3));
		bag.write("/bayer/image_raw", bagTime(200 * k + 62), imageMessage(200 * i + 3, "cam0", "bayer_grbg8", i, 1));
		bag.write("/deep/image_raw", bagTime(200 * k + 63), imageMessage(200 * i + 4, "cam0", "mono16", i, 2));
	}
}

/** All of them, in many small chunks. */
inline void writeBagOfAllTypes(const std::string& path, rosbag::CompressionType compression = rosbag::compression::Uncompressed)
{
	rosbag::Bag bag(path, rosbag::bagmode::Write);
	bag.setCompression(compression);
	bag.setChunkThreshold(8192);
	writeUsualTypes(bag);
	writeOtherTypes(bag);
	bag.close();
}
}  // namespace viwo::testing
