#include "AllTypesBag.h"
#include "BagFixture.h"
#include "ExpectError.h"

#include <viwo/core/Trajectory.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

using namespace viwo;
using namespace viwo::testing;

namespace
{
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/** Twenty seconds of driving back and forth with an IMU that lies on its side and looks to the right; both may be edited. */
struct DriveBag
{
	const Eigen::Quaterniond R_OB = Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitZ()) *
	                                Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ());
	std::function<void(int, sensor_msgs::Imu&)> edit_imu = [](int, sensor_msgs::Imu&) {};
	std::function<void(int, nav_msgs::Odometry&)> edit_odometry = [](int, nav_msgs::Odometry&) {};

	void write(const std::string& path) const
	{
		rosbag::Bag bag(path, rosbag::bagmode::Write);
		for (int i = 0; i < 1000; ++i)
		{
			const double t_s = 0.02 * i;
			auto imu = imuMessage(20 * i, R_OB.conjugate() * Eigen::Vector3d(0.4 * std::cos(t_s), 0, 9.81),
			                      R_OB.conjugate() * Eigen::Vector3d(0, 0, 0.1));
			edit_imu(i, imu);
			bag.write("/imu", bagTime(20 * i), imu);
			auto odometry = odometryMessage(20 * i, 0.4 * std::sin(t_s), 0.1);
			edit_odometry(i, odometry);
			bag.write("/odom", bagTime(20 * i), odometry);
		}
		bag.close();
	}
};

class RosBagDoubts : public RosBag
{
   protected:
	Pose3 importedImuPose() const { return fromMrpt(RawlogContent(path("x.rawlog")).imu.at(0)->sensorPose); }
	/** Odometry from /odom to base_link, what the truth says, and tf that links the two only after half a second. */
	void writeTruthBag(const std::string& truth_frame, const Pose3& T_base_truth)
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 20; ++i)
		{
			bag.write("/odom", bagTime(50 * i), odometryMessage(50 * i, 0.1, 0));
			auto truth = odometryMessage(50 * i, 0, 0, 1);
			truth.child_frame_id = truth_frame;
			bag.write("/truth", bagTime(50 * i), truth);
			auto pose = stamped<geometry_msgs::PoseStamped>(50 * i, "world");
			pose.pose.orientation.w = 1;
			bag.write("/vicon", bagTime(50 * i), pose);
			if (i < 10) continue;
			tf2_msgs::TFMessage frames;
			frames.transforms = {transform("base_link", "marker", T_base_truth)};
			bag.write("/tf", bagTime(50 * i), frames);
		}
		bag.close();
	}
	static std::string wheelsAnd(const std::string& general) { return "[general]\n" + general + "\n[ODOMETRY]\ntopic = /odom\n"; }
};
}  // namespace

TEST_F(RosBagDoubts, ValuesThatAreNotFiniteDoNotTurnTheImu)
{
	DriveBag drive;
	drive.edit_imu = [](int i, sensor_msgs::Imu& imu)
	{
		if (i == 0 || i == 500) imu.linear_acceleration.x = imu.linear_acceleration.y = imu.linear_acceleration.z = kNan;
		if (i == 700) imu.angular_velocity.y = kNan;
	};
	drive.edit_odometry = [](int i, nav_msgs::Odometry& odometry)
	{
		if (i % 200 == 7) odometry.twist.twist.linear.x = kNan;
	};
	drive.write(path("x.bag"));
	const ImportResult result = import();
	EXPECT_NEAR(importedImuPose().R.angularDistance(drive.R_OB), 0, 1e-7);
	EXPECT_TRUE(isNote(result, "IMU: tf has no frame 'imu_link' under 'base_link'; by its mean specific force"));
	EXPECT_TRUE(isNote(result, "forward by the odometry's accelerations"));
	EXPECT_TRUE(isNote(result, "IMU: not finite: 3 of 1000 samples"));
	EXPECT_TRUE(isNote(result, "ODOMETRY: twists that are not finite: 5 of 1000"));
	for (const std::string& note : result.notes) EXPECT_EQ(note.find("nan"), std::string::npos) << note;
}

TEST_F(RosBagDoubts, AStampFarOffDoesNotEndTheLookAtTheImu)
{
	DriveBag drive;
	drive.edit_imu = [](int i, sensor_msgs::Imu& imu)
	{
		if (i == 1) imu.header.stamp = ros::Time(4000000000u, 0);
	};
	drive.write(path("x.bag"));
	EXPECT_TRUE(isNote(import(), "forward by the odometry's accelerations"));
}

TEST_F(RosBagDoubts, UpIsFoundOnAClockThatIsFarOff)
{
	DriveBag drive;
	drive.edit_imu = [](int i, sensor_msgs::Imu& imu) { imu.header.stamp = ros::Time(1000) + ros::Duration(0.02 * i); };
	drive.write(path("x.bag"));
	const ImportResult result = import();
	EXPECT_FALSE(isNote(result, "samples to tell its axes"));
	EXPECT_TRUE(isNote(result, "does a sensor have another clock?"));
	EXPECT_NEAR((importedImuPose().R * Eigen::Vector3d::UnitY()).z(), 1, 1e-9);
	import({}, true);
	EXPECT_NEAR(importedImuPose().R.angularDistance(drive.R_OB), 0, 1e-7) << "by the recorder's stamps";
}

TEST_F(RosBagDoubts, AJointThatIsNotThereIsToldWithThoseThatAre)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 20; ++i) bag.write("/joints", bagTime(50 * i), wheelsMessage(50 * i));
		auto valueless = wheelsMessage(0);
		valueless.position.clear();
		bag.write("/valueless", bagTime(0), valueless);
		bag.close();
	}
	const auto map = [this](const std::string& topic, const std::string& left)
	{
		return writeMap("[ODOMETRY]\ntopic = " + topic + "\nleft_joints = " + left +
		                "\nright_joints = fr rr\nwheel_radius_m = 0.1\ntrack_m = 0.5\n");
	};
	EXPECT_EQ(import(map("/joints", "fl rl")).odometry_samples, 19u);
	expectError([&] { import(map("/joints", "fl xx")); }, {"x.bag", "[ODOMETRY] left_joints = fl xx", "no joint xx", "fl, fr, rl, rr"});
	expectError([&] { import(map("/valueless", "fl rl")); }, {"x.bag", "no message of /valueless", "positions or velocities"});
}

TEST_F(RosBagDoubts, TruthOfAnotherFrameIsMovedToOFromItsFirstPose)
{
	writeTruthBag("marker", {Eigen::Quaterniond::Identity(), {0.2, 0, 0}});
	const ImportResult result = import(writeMap(wheelsAnd("ground_truth = /truth")));
	EXPECT_FALSE(result.ground_truth_assumed);
	EXPECT_FALSE(isNote(result, "/truth"));
	const Trajectory truth = Trajectory::loadTum(result.ground_truth_path);
	ASSERT_EQ(truth.size(), 20u);
	for (const StampedPose& pose : truth.poses()) EXPECT_NEAR(pose.T.p.x(), 0.8, 1e-9);
}

TEST_F(RosBagDoubts, TruthOfAFrameThatNothingLeadsToIsSaidToBeTaken)
{
	writeTruthBag("hat", {});
	const ImportResult apart = import(writeMap(wheelsAnd("ground_truth = /truth")));
	EXPECT_TRUE(apart.ground_truth_assumed);
	EXPECT_TRUE(isNote(apart, "/truth: tf has no way from its frame 'hat' to 'base_link'"));
	const ImportResult nameless = import(writeMap(wheelsAnd("ground_truth = /vicon")));
	EXPECT_TRUE(nameless.ground_truth_assumed);
	EXPECT_TRUE(isNote(nameless, "/vicon: its messages do not say of which frame"));
}

TEST_F(RosBagDoubts, BaseFrameMustBeKnown)
{
	writeTruthBag("hat", {});
	for (const char* known : {"base_link", "/marker", "odom"})
		EXPECT_NO_THROW(import(writeMap(wheelsAnd(std::string("base_frame = ") + known))));
	expectError([&] { import(writeMap(wheelsAnd("base_frame = nope"))); },
	            {"x.bag", "base_frame = nope", "neither tf nor a message", "base_link, marker, odom"});
}

TEST_F(RosBagDoubts, WhatDoesNotCountIsRefusedInAMap)
{
	writeFullBag(path("x.bag"));
	for (const char* key : {"left_joints = a", "wheel_radius_m = 0.1"})
		expectError([&] { import(writeMap(std::string("[ODOMETRY]\ntopic = /odom\n") + key + "\n")); },
		            {"map.ini: [ODOMETRY]", "left_joints", "JointState", "/odom is a nav_msgs/Odometry"});
	expectError([&] { import(writeMap("[ODOMETRY]\ntopic = /odom\nposition_m = 1 0 0\nyaw_pitch_roll_deg = 0 0 0\n")); },
	            {"map.ini: [ODOMETRY]", "position_m", "/odom"});
	expectError([&] { import(writeMap("[IMU]\ntopic = /imu\ncamera_info = /cam0/camera_info\n")); },
	            {"map.ini: [IMU]", "camera_info", "/imu is a sensor_msgs/Imu"});
}

TEST_F(RosBagDoubts, AFailedImportLeavesNothingOfItsOwn)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 5; ++i) bag.write("/cam/image_raw", bagTime(100 * i), imageMessage(100 * i, "cam", "mono8", i, 1));
		bag.write("/cam/image_raw", bagTime(500), imageMessage(500, "cam", "32FC1", 5, 4));
		bag.close();
	}
	expectError([&] { import(); }, {"32FC1"});
	EXPECT_FALSE(std::filesystem::exists(path("x_Images")));

	const std::string there = path("x_Images/CAM_1600000000.100000000.png");
	std::filesystem::create_directory(path("x_Images"));
	writeFile(there, "of an import before");
	expectError([&] { import(); }, {"32FC1"});
	EXPECT_TRUE(std::filesystem::exists(there));
	size_t files = 0;
	for (const auto& entry : std::filesystem::directory_iterator(path("x_Images"))) files += entry.is_regular_file();
	EXPECT_EQ(files, 1u);
}

// The IMU's transform is none, the rear axle's only now and then.
TEST_F(RosBagDoubts, TransformsThatAreNoneAreCounted)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 20; ++i)
		{
			tf2_msgs::TFMessage frames;
			frames.transforms = {transform("base_link", "/imu_link", {}),
			                     transform("base_link", "rear_axle", Pose3(Eigen::Quaterniond::Identity(), {-1, 0, 0}))};
			frames.transforms[0].transform.rotation.w = 0;
			if (i % 5 == 0) frames.transforms[1].transform.translation.x = kNan;
			bag.write(i == 7 ? "/tf_static" : "/tf", bagTime(50 * i), frames);
			bag.write("/imu", bagTime(50 * i), imuMessage(50 * i, {0, 0, 9.81}, {0, 0, 0}));
			auto odometry = odometryMessage(50 * i, 0.3, 0.2);
			odometry.child_frame_id = "rear_axle";
			bag.write("/odom", bagTime(50 * i), odometry);
		}
		bag.close();
	}
	const ImportResult result = import(writeMap("[general]\nbase_frame = base_link\n[IMU]\ntopic = /imu\n[ODOMETRY]\ntopic = /odom\n"));
	EXPECT_TRUE(
	    isNote(result, "tf: left out: 20 transforms from 'base_link' to 'imu_link', with a value that is not finite or a quaternion"));
	EXPECT_TRUE(isNote(result, "tf: left out: 4 transforms from 'base_link' to 'rear_axle'"));
	EXPECT_TRUE(isNote(result, "IMU: tf has no transform that is one to 'imu_link' under 'base_link'"));
	EXPECT_TRUE(isNote(result, "are those of 'rear_axle', moved to 'base_link' by tf"));
}
