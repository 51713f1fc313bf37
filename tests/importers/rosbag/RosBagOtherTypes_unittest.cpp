#include "BagFixture.h"
#include "ExpectError.h"

#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <viwo/importers/RecordingInfo.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <cstring>
#include <limits>

using namespace viwo;
using namespace viwo::testing;

namespace
{
constexpr char kWheels[] = "[ODOMETRY]\ntopic = /joints\nleft_joints = fl rl\nright_joints = fr rr\nwheel_radius_m = 0.1\ntrack_m = 0.5\n";

/** Left wheels at 2 and 4 rad/s, right ones at 6 and 8: with r = 0.1 m, l = 0.5 m, v = 0.5 m/s, w = 0.8 rad/s. */
sensor_msgs::JointState wheels(int64_t t_ms, bool positions)
{
	auto state = stamped<sensor_msgs::JointState>(t_ms, "");
	state.name = {"rr", "arm", "fl", "fr", "rl"};
	const std::vector<double> rates{8, 99, 2, 6, 4};
	for (const double rate : rates)
		(positions ? state.position : state.velocity).push_back(positions ? 1e-3 * static_cast<double>(t_ms) * rate : rate);
	return state;
}

cv::Mat importedPicture(const std::string& rawlog)
{
	return cv::imread(RawlogContent(rawlog).images.at(0)->image.getExternalStorageFileAbsolutePath(), cv::IMREAD_UNCHANGED);
}
}  // namespace

TEST_F(RosBag, WheelsOfJointStates)
{
	for (const bool positions : {true, false})
	{
		{
			rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
			auto arm = stamped<sensor_msgs::JointState>(5, "");
			arm.name = {"arm"}, arm.position = {1};
			for (int i = 0; i < 20; ++i) bag.write("/joints", bagTime(50 * i), wheels(50 * i, positions));
			bag.write("/joints", bagTime(5), arm);
			bag.close();
		}
		const ImportResult result = import(writeMap(kWheels));
		// The first positions have nothing before them.
		EXPECT_EQ(result.odometry_samples, positions ? 19u : 20u);
		const RawlogContent content(path("x.rawlog"));
		ASSERT_EQ(content.odometry.size(), result.odometry_samples);
		for (const auto& odometry : content.odometry)
		{
			EXPECT_NEAR(odometry->velocityLocal.vx, 0.5, 1e-9);
			EXPECT_NEAR(odometry->velocityLocal.omega, 0.8, 1e-9);
		}
	}
	expectError([&] { import(writeMap("[ODOMETRY]\ntopic = /joints\n")); }, {"[ODOMETRY]", "left_joints", "track_m"});
	expectError([&] { import(); }, {"no topic can become an observation", "/joints"});
}

TEST_F(RosBag, PointClouds)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		auto cloud = stamped<sensor_msgs::PointCloud2>(7, "velodyne");
		for (const char* name : {"intensity", "z", "x", "y"})
		{
			sensor_msgs::PointField field;
			field.name = name, field.offset = static_cast<uint32_t>(4 * cloud.fields.size());
			field.datatype = sensor_msgs::PointField::FLOAT32, field.count = 1;
			cloud.fields.push_back(field);
		}
		cloud.width = 3, cloud.height = 1, cloud.point_step = 20, cloud.row_step = 60;
		cloud.data.resize(60);
		const float nan = std::numeric_limits<float>::quiet_NaN();
		const float values[3][4] = {{50, 3, 1, 2}, {60, nan, nan, nan}, {70, -6, -4, -5}};
		for (size_t i = 0; i < 3; ++i) std::memcpy(&cloud.data[20 * i], values[i], sizeof values[i]);
		bag.write("/points", bagTime(8), cloud);
		bag.close();
	}
	const ImportResult result = import();
	EXPECT_EQ(result.point_clouds, 1u);
	EXPECT_TRUE(isNote(result, "POINTS: the vehicle's frame is not known"));
	const auto clouds = observationsOf<mrpt::obs::CObservationPointCloud>(path("x.rawlog"), "POINTS");
	ASSERT_EQ(clouds.size(), 1u);
	EXPECT_EQ(stampOf(*clouds[0]), at_ns(7));
	ASSERT_EQ(clouds[0]->pointcloud->size(), 2u);
	float x = 0, y = 0, z = 0;
	clouds[0]->pointcloud->getPoint(1, x, y, z);
	EXPECT_EQ(x, -4);
	EXPECT_EQ(y, -5);
	EXPECT_EQ(z, -6);
}

TEST_F(RosBag, SpeedsOfTwistStamped)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		auto twist = stamped<geometry_msgs::TwistStamped>(10, "base_link");
		twist.twist.linear.x = 0.3, twist.twist.angular.z = -0.2;
		bag.write("/vehicle/twist", bagTime(11), twist);
		twist.header.stamp = ros::Time();
		bag.write("/vehicle/twist", bagTime(31), twist);
		bag.close();
	}
	const ImportResult result = import();
	EXPECT_TRUE(isNote(result, "ODOMETRY: without a stamp: 1 of 2 headers"));
	const RawlogContent content(path("x.rawlog"));
	ASSERT_EQ(content.odometry.size(), 2u);
	EXPECT_EQ(content.odometry[0]->velocityLocal.vx, 0.3);
	EXPECT_EQ(content.odometry[0]->velocityLocal.omega, -0.2);
	EXPECT_EQ(stampOf(*content.odometry[1]), at_ns(31));
}

// The brightest pixel of 1000 says 10 bits: 8 are left after two are dropped. Both byte orders.
TEST_F(RosBag, PicturesOf16Bit)
{
	for (const bool big_endian : {false, true})
	{
		{
			rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
			auto image = imageMessage(0, "cam", "mono16", 0, 2);
			image.is_bigendian = big_endian;
			std::fill(image.data.begin(), image.data.end(), uint8_t{0});
			image.data[big_endian ? 0 : 1] = 1000 >> 8, image.data[big_endian ? 1 : 0] = 1000 & 0xFF;
			image.data[big_endian ? 3 : 2] = 200;
			bag.write("/cam/image_raw", bagTime(0), image);
			bag.close();
		}
		EXPECT_TRUE(isNote(import(), "10 are in use"));
		const cv::Mat picture = importedPicture(path("x.rawlog"));
		ASSERT_EQ(picture.type(), CV_8UC1);
		EXPECT_EQ(picture.at<uint8_t>(0, 0), 250);
		EXPECT_EQ(picture.at<uint8_t>(0, 1), 50);
		EXPECT_EQ(picture.at<uint8_t>(5, 5), 0);
	}
}

// A picture of one colour through each pattern: inside, every pixel has that colour.
TEST_F(RosBag, BayerPatterns)
{
	const cv::Vec3b bgr(40, 120, 200);
	for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"})
	{
		{
			rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
			auto image = imageMessage(0, "cam", "bayer_" + pattern + "8", 0, 1);
			for (uint32_t row = 0; row < image.height; ++row)
				for (uint32_t column = 0; column < image.width; ++column)
				{
					const char colour = pattern[2 * (row % 2) + column % 2];
					image.data[row * image.step + column] = colour == 'b' ? bgr[0] : colour == 'g' ? bgr[1] : bgr[2];
				}
			bag.write("/cam/image_raw", bagTime(0), image);
			bag.close();
		}
		import();
		const cv::Mat picture = importedPicture(path("x.rawlog"));
		ASSERT_EQ(picture.type(), CV_8UC3);
		for (int row = 2; row < 10; ++row)
			for (int column = 2; column < 14; ++column) ASSERT_EQ(picture.at<cv::Vec3b>(row, column), bgr) << pattern;
	}
}

TEST_F(RosBag, InfoOfABag)
{
	writeOdometryBag(path("x.bag"), 40);
	const RecordingInfo info = inspectRecording(path("x.bag"), [](double) { return true; });
	ASSERT_EQ(info.streams.size(), 1u);
	EXPECT_EQ(info.streams[0].name, "/odom");
	EXPECT_EQ(info.streams[0].count, 40u);
	EXPECT_NEAR(info.streams[0].rate_hz, 20, 1e-9);
	EXPECT_EQ(info.streams[0].role, SensorRole::wheels);
}

// A camera on a mast that turns, an odometry without twists, an IMU in g: all of it is said.
TEST_F(RosBag, WhatLooksWrongIsSaid)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 10; ++i)
		{
			tf2_msgs::TFMessage frames;
			frames.transforms = {
			    transform("base_link", "cam", {Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ())), {0, 0, 0}})};
			bag.write("/tf", bagTime(100 * i), frames);
			bag.write("/cam/image_raw", bagTime(100 * i + 1), imageMessage(100 * i, "cam", "mono8", i, 1));
			bag.write("/odom", bagTime(100 * i + 2), odometryMessage(100 * i, 0, 0, 0.1 * i));
			bag.write("/imu", bagTime(100 * i + 3), imuMessage(100 * i, {0, 0, 1}, {0, 0, 0}));
		}
		bag.close();
	}
	const ImportResult result = import();
	EXPECT_TRUE(isNote(result, "CAM: tf moves it on the vehicle, by 0.000 m and 51.57 deg"));
	EXPECT_TRUE(isNote(result, "CAM: no CameraInfo"));
	EXPECT_TRUE(isNote(result, "ODOMETRY: all twists are zero, but the pose moves"));
	EXPECT_TRUE(isNote(result, "IMU: the mean specific force is 1.000 m/s^2"));
}
