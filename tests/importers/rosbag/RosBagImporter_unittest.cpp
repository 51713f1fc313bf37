#include "AllTypesBag.h"
#include "BagFixture.h"
#include "ExpectError.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <viwo/core/Trajectory.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <limits>
#include <random>

using namespace viwo;
using namespace viwo::testing;

TEST_F(RosBag, AllTypesComeBackEqual)
{
	writeFullBag(path("x.bag"));
	const ImportResult result = import();
	EXPECT_EQ(result.imu_samples, 100u);
	EXPECT_EQ(result.odometry_samples, 40u);
	EXPECT_EQ(result.images, 20u);
	EXPECT_EQ(result.scans, 10u);
	EXPECT_EQ(result.gps_fixes, 10u);
	EXPECT_NEAR(result.duration_s, 1.98, 1e-9);
	EXPECT_NE(result.mapping.find("[CAM]\ntopic = /cam0/image_raw\ncamera_info = /cam0/camera_info"), std::string::npos) << result.mapping;
	EXPECT_NE(result.mapping.find("[CAM2]\ntopic = /cam1/image_raw/compressed\ncamera_info = /cam1/camera_info"), std::string::npos);
	EXPECT_TRUE(isNote(result, "put in order: "));
	EXPECT_FALSE(isNote(result, "out of order"));

	RawlogReaderOptions strict;
	strict.reorder_window_s = 0;
	RawlogReader in_order(path("x.rawlog"), strict);
	while (in_order.next())
	{
	}
	EXPECT_EQ(in_order.counts().late, 0u);

	const RawlogContent content(path("x.rawlog"));
	ASSERT_EQ(content.imu.size(), 100u);
	for (int i = 0; i < 100; ++i)
	{
		const auto& imu = *content.imu[static_cast<size_t>(i)];
		EXPECT_EQ(stampOf(imu), at_ns(20 * i));
		EXPECT_EQ(imu.get(mrpt::obs::IMU_X_ACC), 0.1);
		EXPECT_EQ(imu.get(mrpt::obs::IMU_Z_ACC), 0.01 * i);
		EXPECT_EQ(imu.get(mrpt::obs::IMU_WX), 0.1);
		EXPECT_EQ(imu.get(mrpt::obs::IMU_WY), 0.2);
		EXPECT_EQ(imu.get(mrpt::obs::IMU_WZ), 0.3 + (i ^ 1));
		EXPECT_FALSE(imu.has(mrpt::obs::IMU_ORI_QUAT_W));
		expectSamePose(imu.sensorPose, kT_OB, "IMU");
	}
	ASSERT_EQ(content.odometry.size(), 40u);
	for (int i = 0; i < 40; ++i)
	{
		const auto& odometry = *content.odometry[static_cast<size_t>(i)];
		EXPECT_EQ(stampOf(odometry), at_ns(50 * i));
		EXPECT_EQ(odometry.velocityLocal.vx, 0.5);
		EXPECT_EQ(odometry.velocityLocal.omega, 0.1 * i);
		EXPECT_EQ(odometry.odometry.x(), 0.025 * i);
		EXPECT_NEAR(odometry.odometry.phi(), 0.01 * i, 1e-12);
	}
}

TEST_F(RosBag, PicturesAndLenses)
{
	writeFullBag(path("x.bag"));
	import();
	const auto left = observationsOf<mrpt::obs::CObservationImage>(path("x.rawlog"), "CAM");
	const auto right = observationsOf<mrpt::obs::CObservationImage>(path("x.rawlog"), "CAM2");
	ASSERT_EQ(left.size(), 10u);
	ASSERT_EQ(right.size(), 10u);
	for (int n = 0; n < 10; ++n)
	{
		const auto& observation = *left[static_cast<size_t>(n)];
		EXPECT_EQ(stampOf(observation), at_ns(200 * n));
		expectSamePose(observation.cameraPose, kT_OC, "CAM, over a chain of two");
		const cv::Mat picture = cv::imread(observation.image.getExternalStorageFileAbsolutePath(), cv::IMREAD_UNCHANGED);
		ASSERT_EQ(picture.cols, 16);
		ASSERT_EQ(picture.channels(), n % 2 == 0 ? 1 : 3);
		const size_t row_bytes = n % 2 == 0 ? 20 : 52;
		for (int row = 0; row < 12; ++row)
			for (int column = 0; column < 16; ++column)
			{
				const size_t byte = static_cast<size_t>(row) * row_bytes + static_cast<size_t>(column) * (n % 2 == 0 ? 1 : 3);
				if (n % 2 == 0)
					ASSERT_EQ(picture.at<uint8_t>(row, column), shade(n, byte));
				else
					ASSERT_EQ(picture.at<cv::Vec3b>(row, column), cv::Vec3b(shade(n, byte + 2), shade(n, byte + 1), shade(n, byte)));
			}
	}
	const CameraModel plumb_bob = fromMrpt(left[0]->cameraParams), equidistant = fromMrpt(right[0]->cameraParams);
	EXPECT_EQ(plumb_bob.distortion(), CameraModel::Distortion::plumb_bob);
	EXPECT_EQ(plumb_bob.fy_px(), 11);
	EXPECT_EQ(plumb_bob.cx_px(), 7.5);
	EXPECT_EQ(plumb_bob.coefficients(), (std::array<double, 5>{-0.3, 0.1, 1e-3, 2e-3, 0.01}));
	EXPECT_EQ(equidistant.distortion(), CameraModel::Distortion::kannala_brandt);
	EXPECT_EQ(equidistant.coefficients()[3], 1e-3);
	std::vector<uint8_t> expected;
	cv::imencode(".jpg", cv::Mat(12, 16, CV_8U, cv::Scalar(30)), expected);
	EXPECT_EQ(readFile(right[3]->image.getExternalStorageFileAbsolutePath()), std::string(expected.begin(), expected.end()));
}

TEST_F(RosBag, ScansAndFixes)
{
	writeFullBag(path("x.bag"));
	const ImportResult result = import();
	const auto scans = observationsOf<mrpt::obs::CObservation2DRangeScan>(path("x.rawlog"), "LASER");
	ASSERT_EQ(scans.size(), 10u);
	const auto& scan = *scans[2];
	EXPECT_EQ(stampOf(scan), at_ns(405));
	EXPECT_NEAR(scan.aperture, 2.5, 1e-6);
	// From -1.5 to 1 rad: MRPT's scan is that of a sensor turned by -0.25.
	expectSamePose(scan.sensorPose, kT_OL * Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(-0.25, Eigen::Vector3d::UnitZ())), {0, 0, 0}),
	               "LASER");
	const std::vector<bool> returns{true, false, true, false, false, true};
	for (size_t i = 0; i < returns.size(); ++i) EXPECT_EQ(scan.getScanRangeValidity(i), returns[i]) << i;
	EXPECT_EQ(scan.getScanRange(5), 8.0f);

	const auto fixes = observationsOf<mrpt::obs::CObservationGPS>(path("x.rawlog"), "GPS");
	ASSERT_EQ(fixes.size(), 10u);
	// MRPT packs these fields: no reference may be bound to them.
	const auto ofFix = [&fixes](size_t i) { return fixes[i]->getMsgByClass<mrpt::obs::gnss::Message_NMEA_GGA>().fields; };
	EXPECT_EQ(double{ofFix(2).latitude_degrees}, 2e-5);
	EXPECT_EQ(int{ofFix(2).fix_quality}, 1);
	EXPECT_EQ(int{ofFix(3).fix_quality}, 0);
	const Trajectory track = Trajectory::loadTum(result.gps_path);
	ASSERT_EQ(track.size(), 9u);
	// A degree of latitude at the equator is a (1 - e^2) pi / 180 = 110574.3 m.
	const Eigen::Vector3d last = track.poses().back().T.p;
	EXPECT_NEAR(last.y(), 9e-5 * 110574.3, 1e-4);
	EXPECT_NEAR(last.x(), 0, 1e-9);
	EXPECT_NEAR(last.z(), 0, 1e-4);
}

TEST_F(RosBag, MapChoosesPosesTruthAndStamps)
{
	writeFullBag(path("x.bag"));
	const std::string map = writeMap(
	    "[general]\nground_truth = /vicon\n[GYRO]\ntopic = /imu // of the bag\nposition_m = 1 2 3 // in O\nyaw_pitch_roll_deg = 90 0 "
	    "0\n[WHEELS]\ntopic = "
	    "/odom\n");
	const ImportResult result = import(map, true);
	EXPECT_EQ(result.images, 0u);
	EXPECT_EQ(result.ground_truth_poses, 10u);
	EXPECT_EQ(Trajectory::loadTum(result.ground_truth_path).poses()[4].T.p.x(), 0.4);
	const RawlogContent content(path("x.rawlog"));
	ASSERT_EQ(content.imu.size(), 100u);
	EXPECT_EQ(content.imu[3]->sensorLabel, "GYRO");
	EXPECT_EQ(stampOf(*content.imu[3]), at_ns(100));
	expectSamePose(content.imu[3]->sensorPose, {Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())), {1, 2, 3}},
	               "GYRO");
	EXPECT_EQ(content.odometry[3]->sensorLabel, "WHEELS");
	EXPECT_TRUE(isNote(result, "GYRO: with its pose, gravity is 87 deg"));

	expectError([&] { import(writeMap("[IMU]\ntopic = /imu/data\n")); }, {"map.ini: [IMU] topic = /imu/data", "/imu (sensor_msgs/Imu)"});
	expectError([&] { import(writeMap("[IMU]\ntopik = /imu\n")); }, {"map.ini", "[IMU] topik", "unknown key", "topic"});
	expectError([&] { import(writeMap("[IMU]\ntopic = /tf\n")); }, {"[IMU] topic = /tf", "cannot become an observation"});
	expectError([&] { import(writeMap("[IMU]\ntopic = /imu\nposition_m = 1 2\n")); }, {"position_m", "three numbers"});
	expectError([&] { import(writeMap("[CAM]\ntopic = /cam0/image_raw\ncamera_info = /odom\n")); }, {"camera_info", "nav_msgs/Odometry"});
	expectError([&] { import(writeMap("")); }, {"map.ini", "no section"});
	expectError([&] { import(path("absent.ini")); }, {"absent.ini", "cannot be read"});
}

// What is printed as the proposal gives the same rawlog when it is given back.
TEST_F(RosBag, PrintedMapIsAMap)
{
	writeFullBag(path("x.bag"));
	const ImportResult proposed = import();
	const std::string bytes = readFile(path("x.rawlog"));
	const ImportResult again = import(writeMap(proposed.mapping));
	EXPECT_EQ(again.mapping, proposed.mapping);
	EXPECT_TRUE(readFile(path("x.rawlog")) == bytes);
}

// An IMU on its side that tf does not know: up by gravity, forward by the odometry's accelerations. All 24 mountings.
TEST_F(RosBag, AxesOfAnImuThatNobodyPlaces)
{
	int mountings = 0;
	for (int quarter = 0; quarter < 4; ++quarter)
		for (const Eigen::Vector3d& up : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, 1, 0),
		                                  Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1)})
		{
			const Eigen::Quaterniond R_OB = Eigen::AngleAxisd(quarter * M_PI / 2, Eigen::Vector3d::UnitZ()) *
			                                Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ());
			std::mt19937 generator(7);
			std::normal_distribution<double> noise(0, 0.2);
			{
				rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
				for (int i = 0; i < 1000; ++i)
				{
					const double t_s = 0.02 * i, a_m_s2 = 0.4 * std::cos(t_s), w_rad_s = 0.5 * std::sin(0.7 * t_s);
					const Eigen::Vector3d force_O(a_m_s2 + noise(generator), noise(generator), 9.81);
					bag.write("/imu", bagTime(20 * i),
					          imuMessage(20 * i, R_OB.conjugate() * force_O, R_OB.conjugate() * Eigen::Vector3d(0, 0, w_rad_s)));
					if (i % 5 == 0) bag.write("/odom", bagTime(20 * i), odometryMessage(20 * i, 0.4 * std::sin(t_s), w_rad_s));
				}
				bag.close();
			}
			const ImportResult result = import();
			expectSamePose(RawlogContent(path("x.rawlog")).imu[0]->sensorPose, {R_OB, {0, 0, 0}}, "mounting " + std::to_string(mountings));
			EXPECT_TRUE(isNote(result, "forward by the odometry's accelerations"));
			EXPECT_NE(result.mapping.find("yaw_pitch_roll_deg"), std::string::npos);
			++mountings;
		}
	EXPECT_EQ(mountings, 24);
}

TEST_F(RosBag, SeveralBagsAreOneRecording)
{
	writeOdometryBag(path("a.bag"), 20);
	{
		rosbag::Bag bag(path("b.bag"), rosbag::bagmode::Write);
		for (int i = 20; i < 50; ++i) bag.write("/odom", bagTime(50 * i), odometryMessage(50 * i, 0.01 * i, 0.1));
		bag.close();
	}
	const ImportResult result = importRosBags({"", path("x.rawlog")}, {{path("b.bag"), path("a.bag")}, {}, false});
	EXPECT_EQ(result.odometry_samples, 50u);
	const RawlogContent content(path("x.rawlog"));
	for (size_t i = 0; i < content.odometry.size(); ++i) EXPECT_EQ(content.odometry[i]->velocityLocal.vx, 0.01 * static_cast<double>(i));
	expectError([&] { importRosBags({"", path("y.rawlog")}, {{path("a.bag"), path("./a.bag")}, {}, false}); }, {"a.bag", "given twice"});
}
