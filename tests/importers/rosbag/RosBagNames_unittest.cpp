#include "AllTypesBag.h"
#include "BagFixture.h"
#include "ExpectError.h"

#include <viwo/core/Trajectory.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <filesystem>

using namespace viwo;
using namespace viwo::testing;

/** Names of files, of tf's topics, and what has none. */
class RosBagNames : public RosBag
{
   protected:
	static tf2_msgs::TFMessage imuAt(double x_m)
	{
		tf2_msgs::TFMessage frames;
		frames.transforms = {transform("base_link", "imu_link", {Eigen::Quaterniond::Identity(), {x_m, 0, 0}})};
		return frames;
	}
	/** An IMU and odometry under /robot2, and tf topics with the IMU at these places. */
	double importedImu_m(const std::vector<std::pair<std::string, double>>& tf, ImportResult& result)
	{
		{
			rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
			for (const auto& [topic, x_m] : tf) bag.write(topic, bagTime(0), imuAt(x_m));
			for (int i = 0; i < 20; ++i)
			{
				bag.write("/robot2/imu", bagTime(50 * i), imuMessage(50 * i, {0, 0, 9.8}, {0, 0, 0}));
				bag.write("/robot2/odom", bagTime(50 * i), odometryMessage(50 * i, 0.1, 0));
			}
			bag.close();
		}
		result = import();
		return RawlogContent(path("x.rawlog")).imu.at(0)->sensorPose.x();
	}
};

TEST_F(RosBagNames, TfInNamespacesIsTaken)
{
	ImportResult result;
	for (const char* topic : {"/robot2/tf_static", "/robot2/tf"})
	{
		EXPECT_EQ(importedImu_m({{topic, 0.7}}, result), 0.7);
		EXPECT_TRUE(isNote(result, std::string("tf is taken from ") + topic + ", too"));
	}
	EXPECT_EQ(importedImu_m({{"/tf_static", 0.7}}, result), 0.7);
	EXPECT_FALSE(isNote(result, "tf is taken from"));
	// The plain one first, then that of the topics' namespace.
	EXPECT_EQ(importedImu_m({{"/robot1/tf_static", 0.1}, {"/robot2/tf_static", 0.2}, {"/tf_static", 0.3}}, result), 0.3);
	EXPECT_EQ(importedImu_m({{"/robot1/tf_static", 0.1}, {"/robot2/tf_static", 0.2}}, result), 0.2);
}

TEST_F(RosBagNames, ACalibrationWithoutASizeTakesThatOfThePictures)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		auto info = cameraInfoMessage("cam0", "plumb_bob", {-0.3, 0.1, 1e-3, 2e-3, 0.01});
		info.width = info.height = 0;
		bag.write("/cam0/camera_info", bagTime(0), info);
		bag.write("/cam0/image_raw", bagTime(1), imageMessage(0, "cam0", "mono8", 0, 1));
		bag.close();
	}
	EXPECT_TRUE(isNote(import(), "CAM: /cam0/camera_info has a calibration for pictures of size 0"));
	const CameraModel camera = fromMrpt(RawlogContent(path("x.rawlog")).images.at(0)->cameraParams);
	EXPECT_EQ(camera.width_px(), 16);
	EXPECT_EQ(camera.height_px(), 12);
	EXPECT_EQ(camera.fy_px(), 11);
	EXPECT_EQ(camera.cx_px(), 7.5);
	EXPECT_EQ(camera.coefficients()[0], -0.3);
}

TEST_F(RosBagNames, FilesOfAnotherImportArePutAside)
{
	writeFullBag(path("x.bag"));
	const ImportResult full = import(writeMap("[general]\nground_truth = /vicon\n[GPS]\ntopic = /fix\n"));
	EXPECT_FALSE(isNote(full, "was there before"));
	const std::string truth = readFile(path("x_ground_truth.tum")), gps = readFile(path("x_gps.tum"));
	const ImportResult again = import(writeMap("[general]\nground_truth = /vicon\n[GPS]\ntopic = /fix\n"));
	EXPECT_FALSE(isNote(again, "was there before"));
	const ImportResult less = import(writeMap("[IMU]\ntopic = /imu\n"));
	EXPECT_TRUE(isNote(less, "x_ground_truth.tum: was there before, and is not of this recording; renamed to"));
	EXPECT_TRUE(isNote(less, "x_gps.tum: was there before"));
	for (const char* name : {"x_ground_truth.tum", "x_gps.tum"}) EXPECT_FALSE(std::filesystem::exists(path(name))) << name;
	EXPECT_EQ(readFile(path("x_ground_truth.tum.old")), truth);
	EXPECT_EQ(readFile(path("x_gps.tum.old")), gps);

	writeFile(path("x_gps.tum"), "another one");
	EXPECT_TRUE(isNote(import(writeMap("[IMU]\ntopic = /imu\n")), "x_gps.tum.old2"));
	EXPECT_EQ(readFile(path("x_gps.tum.old2")), "another one");
	EXPECT_EQ(readFile(path("x_gps.tum.old")), gps) << "one that was put aside before is kept";
}

TEST_F(RosBagNames, FixesThatAreNoneAreSaid)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 7; ++i)
		{
			auto fix = stamped<sensor_msgs::NavSatFix>(200 * i, "gps");
			fix.status.status = -1;
			bag.write("/fix", bagTime(200 * i), fix);
		}
		bag.close();
	}
	const ImportResult result = import();
	EXPECT_TRUE(isNote(result, "GPS: 7 messages, none of them with a fix: no "));
	EXPECT_EQ(result.gps_path, "");
	EXPECT_FALSE(std::filesystem::exists(path("x_gps.tum")));
}

TEST_F(RosBagNames, ALabelWithASlashIsRefused)
{
	writeFullBag(path("x.bag"));
	for (const char* label : {"front/cam", "../../evil", "front\\cam"})
	{
		expectError([&] { import(writeMap(std::string("[") + label + "]\ntopic = /cam0/image_raw\n")); },
		            {"map.ini: [", label, "a label becomes part of file names"});
		EXPECT_FALSE(std::filesystem::exists(path("x_Images")));
	}
}
