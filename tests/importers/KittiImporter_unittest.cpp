#include "ExpectError.h"
#include "KittiOxts.h"
#include "RawlogContent.h"
#include "SmallRecordings.h"

#include <viwo/core/Trajectory.h>
#include <viwo/importers/KittiImporter.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/ObservationAdapter.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

using namespace viwo;
using namespace viwo::testing;

TEST(KittiImporter, CarriesEveryObservation)
{
	const TempFolder folder;
	writeKitti(folder);
	const ImportResult result = importKitti({folder.path(), folder.file("x.rawlog")}, {});
	EXPECT_EQ(result.images, 20u);
	EXPECT_EQ(result.imu_samples, 100u);
	EXPECT_EQ(result.odometry_samples, 100u);
	EXPECT_EQ(result.ground_truth_poses, 100u);
	ASSERT_GE(result.notes.size(), 2u);
	EXPECT_EQ(result.notes[0], "left out, as not there: 1 of 21 images");
	EXPECT_EQ(result.notes[1], "left out, as not there: 1 of 101 OXTS packets");

	const RawlogContent content(folder.file("x.rawlog"));
	ASSERT_EQ(content.images.size(), 20u);
	ASSERT_EQ(content.imu.size(), 100u);
	ASSERT_EQ(content.odometry.size(), 100u);
	EXPECT_EQ(*ImageRef(0, content.images[3]).grey().ptrLine<uint8_t>(10), 40) << "image 3 is absent, so the fourth is image 4";
	EXPECT_EQ(nanosecondsOf(content.images[3]->timestamp), 1317045935900000000) << "date -u -d '2011-09-26 14:05:35.9' +%s%N";
	EXPECT_EQ(content.imu[0]->get(mrpt::obs::IMU_Z_ACC), 9.81);
	EXPECT_EQ(content.imu[0]->get(mrpt::obs::IMU_WY), 0.02);
	EXPECT_NEAR(content.odometry[4]->velocityLocal.vx, kSpeed_m_s, 1e-6);
}

TEST(KittiImporter, TruthFollowsTheOdometry)
{
	const TempFolder folder;
	writeKitti(folder);
	importKitti({folder.path(), folder.file("x.rawlog")}, {});
	const Trajectory truth = Trajectory::loadTum(folder.file("x_ground_truth.tum"));
	const RawlogContent content(folder.file("x.rawlog"));
	for (size_t i = 0; i < truth.size(); ++i)
	{
		const Pose3& T = truth.poses()[i].T;
		const auto& odometry = content.odometry[i]->odometry;
		EXPECT_NEAR(T.p.x(), odometry.x(), 1e-5);
		EXPECT_NEAR(T.p.y(), odometry.y(), 1e-5);
		EXPECT_NEAR(T.p.z(), -0.93, 1e-9);
		EXPECT_NEAR(yawOf(T.R), odometry.phi(), 1e-6);
	}
}

TEST(KittiImporter, CalibrationChains)
{
	const TempFolder folder;
	writeKitti(folder);
	importKitti({folder.path(), folder.file("x.rawlog")}, {});
	const Calibration recorded = readCalibration(folder.file("x.rawlog"), {}, true, true);
	// A point in camera 0 by hand: I -> velodyne -> camera.
	const Eigen::Vector3d x_I(5, 1, 0.5), x_V(5 - 0.8, 1 + 0.3, 0.5 - 0.8), x_C(-x_V.y() + 0.1, -x_V.z() + 0.2, x_V.x() + 0.3);
	EXPECT_LT(((recorded.T_BC().inverse() * x_I) - x_C).norm(), 1e-6);
	EXPECT_NEAR(recorded.T_OB.p.z(), 0.93, 1e-9);
	EXPECT_EQ(recorded.camera.distortion(), CameraModel::Distortion::plumb_bob);
	EXPECT_NEAR(recorded.camera.coefficients()[4], -0.07, 1e-9);

	// Images of the rectified size take the rectified camera, R_rect_00 turned.
	for (int i = 0; i <= 20; ++i) writeImage(folder, format("image_00/data/%010d.png", i), 0, 60, 40);
	importKitti({folder.path(), folder.file("y.rawlog")}, {});
	const Calibration rectified = readCalibration(folder.file("y.rawlog"), {}, true, true);
	EXPECT_LT(((rectified.T_BC().inverse() * x_I) - Eigen::Vector3d(-x_C.y(), x_C.x(), x_C.z())).norm(), 1e-6);
	EXPECT_EQ(rectified.camera.fx_px(), 45);
	EXPECT_EQ(rectified.camera.cy_px(), 20);
}

TEST(KittiImporter, SpeedErrorsAsAsked)
{
	const TempFolder folder;
	writeKitti(folder);
	const auto speeds = [&](const std::string& name, const KittiOptions& options)
	{
		importKitti({folder.path(), folder.file(name)}, options);
		std::vector<double> v;
		const RawlogContent content(folder.file(name));
		for (const auto& odometry : content.odometry) v.push_back(odometry->velocityLocal.vx);
		return v;
	};
	KittiOptions options;
	options.speed_scale = 1.1;
	options.speed_noise_m_s = 0.05;
	const auto a = speeds("a.rawlog", options), b = speeds("b.rawlog", options);
	EXPECT_EQ(a, b);
	options.seed = 2;
	EXPECT_NE(a, speeds("c.rawlog", options));
	double mean = 0, square = 0;
	for (const double v : a) mean += v / static_cast<double>(a.size());
	for (const double v : a) square += (v - mean) * (v - mean) / static_cast<double>(a.size() - 1);
	std::cout << "[measured] speed mean " << mean << " m/s, deviation " << std::sqrt(square) << " m/s\n";
	EXPECT_NEAR(mean, 0.55, 0.02);
	EXPECT_NEAR(std::sqrt(square), 0.05, 0.015);
}

TEST(KittiImporter, CalibrationMayLieAbove)
{
	const TempFolder folder;
	writeKitti(folder);
	std::filesystem::create_directory(folder.file("drive"));
	std::filesystem::rename(folder.file("image_00"), folder.file("drive/image_00"));
	std::filesystem::rename(folder.file("oxts"), folder.file("drive/oxts"));
	EXPECT_EQ(importKitti({folder.file("drive"), folder.file("x.rawlog")}, {}).images, 20u);
}

TEST(KittiImporter, SaysWhatIsWrongInOneLine)
{
	const TempFolder folder;
	const ImportJob job{folder.path(), folder.file("x.rawlog")};
	const auto import = [&] { importKitti(job, {}); };
	expectError([&] { importKitti({folder.file("absent"), folder.file("x.rawlog")}, {}); }, {"absent", "no such folder"});
	expectError(import, {"image_00/timestamps.txt", "cannot be read"});
	writeKitti(folder);
	const auto damaged = [&](const std::string& name, const std::string& content, std::initializer_list<std::string> parts)
	{
		const std::string before = readFile(folder.file(name));
		write(folder, name, content);
		expectError(import, parts);
		write(folder, name, before);
	};
	damaged("image_00/timestamps.txt", kittiStamp(1) + kittiStamp(0), {"image_00/timestamps.txt:2", "not later"});
	damaged("image_00/timestamps.txt", "yesterday\n", {"image_00/timestamps.txt:1", "'yesterday' is not a time"});
	damaged("oxts/data/0000000003.txt", "1 2 3\n", {"0000000003.txt:1", "3 numbers instead of at least 23"});
	damaged("oxts/data/0000000003.txt", "", {"0000000003.txt", "empty"});
	damaged("calib_cam_to_cam.txt", "S_00: 10 10\n", {"calib_cam_to_cam.txt: S_00", "64x48"});
	damaged("calib_cam_to_cam.txt", "S_00: 64 48\nK_00: 1 2\n", {"calib_cam_to_cam.txt: K_00", "2 numbers instead of 9"});
	damaged("calib_velo_to_cam.txt", "T: 0 0 0\nR: 2 0 0 0 1 0 0 0 1\n", {"calib_velo_to_cam.txt: R", "not a rotation"});
	std::filesystem::remove(folder.file("calib_imu_to_velo.txt"));
	expectError(import, {"calib_imu_to_velo.txt", "folder above"});
	std::filesystem::remove_all(folder.file("image_00/data"));
	expectError(import, {"image_00/data", "none of the files"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("x.rawlog")));
}

TEST(KittiOxts, DateTimeIsUtc)
{
	EXPECT_EQ(parseDateTime("1970-01-02 00:00:01", "x"), 86401000000000);
	EXPECT_EQ(parseDateTime("2011-09-26 14:05:35.550923000", "x"), 1317045935550923000);
	for (const char* text : {"", "2011-09-26", "2011-09-26 14:05:35,5", "2011-09-26 14:05:35.5x"})
		expectError([&] { parseDateTime(text, "here"); }, {"here", text});
}
