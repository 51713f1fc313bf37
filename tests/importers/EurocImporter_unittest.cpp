#include "ExpectError.h"
#include "RawlogContent.h"
#include "SmallRecordings.h"

#include <viwo/core/Trajectory.h>
#include <viwo/importers/EurocImporter.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/ObservationAdapter.h>

#include <gtest/gtest.h>

#include <filesystem>

using namespace viwo;
using namespace viwo::testing;

namespace
{
void expectSamePose(const Pose3& a, const Pose3& b, double tolerance)
{
	EXPECT_LT((a.p - b.p).norm(), tolerance);
	EXPECT_LT(a.R.angularDistance(b.R), tolerance);
}
}  // namespace

TEST(EurocImporter, CarriesEveryObservation)
{
	const TempFolder folder;
	writeEuroc(folder);
	const ImportResult result = importEuroc({folder.path(), folder.file("x.rawlog")});
	EXPECT_EQ(result.images, 21u);
	EXPECT_EQ(result.imu_samples, 201u);
	EXPECT_EQ(result.odometry_samples, 41u);
	EXPECT_EQ(result.ground_truth_poses, 101u);
	EXPECT_NEAR(result.duration_s, 2, 1e-6);

	const RawlogContent content(folder.file("x.rawlog"));
	ASSERT_EQ(content.images.size(), 21u);
	ASSERT_EQ(content.imu.size(), 201u);
	ASSERT_EQ(content.odometry.size(), 41u);
	EXPECT_EQ(nanosecondsOf(content.imu[3]->timestamp), kStart_ns + 30000000);
	EXPECT_EQ(content.imu[3]->get(mrpt::obs::IMU_Z_ACC), 12.8);
	EXPECT_EQ(content.imu[3]->get(mrpt::obs::IMU_WX), 0.1);
	EXPECT_EQ(content.imu[3]->get(mrpt::obs::IMU_WZ), kYawRate_rad_s);
	EXPECT_NEAR(content.odometry[9]->velocityLocal.vx, kSpeed_m_s, 1e-6);
	EXPECT_NEAR(content.odometry[9]->velocityLocal.omega, kYawRate_rad_s, 1e-6);
	EXPECT_NEAR(content.odometry.back()->odometry.phi(), 2 * kYawRate_rad_s, 1e-6);
	EXPECT_NEAR(static_cast<double>(nanosecondsOf(content.images[5]->timestamp) - kStart_ns), 500000123, 50);
	EXPECT_EQ(ImageRef(0, content.images[5]).grey().getWidth(), 64u);
	EXPECT_EQ(*ImageRef(0, content.images[5]).grey().ptrLine<uint8_t>(10), 50) << "the image of another stamp";
	EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("x_Images")), {}), 21);
}

TEST(EurocImporter, SensorsSitWhereTheYamlSays)
{
	const TempFolder folder;
	writeEuroc(folder);
	importEuroc({folder.path(), folder.file("x.rawlog")});
	const SmallRig rig;
	const Calibration calibration = readCalibration(folder.file("x.rawlog"), {}, true, true);
	expectSamePose(calibration.T_BO(), rig.T_BO, 1e-6);
	expectSamePose(calibration.T_BC(), rig.T_BC, 1e-6);
	EXPECT_EQ(calibration.camera.distortion(), CameraModel::Distortion::plumb_bob);
	EXPECT_EQ(calibration.camera.fx_px(), 50.5);
	EXPECT_EQ(calibration.camera.cy_px(), 23);
	EXPECT_NEAR(calibration.camera.coefficients()[3], 1.7e-5, 1e-12);

	const Trajectory truth = Trajectory::loadTum(folder.file("x_ground_truth.tum"));
	expectSamePose(truth.poses()[0].T, Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 0.3)) * rig.T_BO, 1e-7);
}

TEST(EurocImporter, WithoutOdometryOIsTheBody)
{
	const TempFolder folder;
	writeEuroc(folder, false);
	const ImportResult result = importEuroc({folder.file("mav0"), folder.file("x.rawlog")});
	EXPECT_EQ(result.odometry_samples, 0u);
	ASSERT_FALSE(result.notes.empty());
	EXPECT_NE(result.notes[0].find("no odom0"), std::string::npos);
	expectSamePose(readCalibration(folder.file("x.rawlog"), {}, true, true).T_OB, {}, 1e-9);
}

TEST(EurocImporter, WhatIsMissingOrNotUsedIsTold)
{
	const TempFolder folder;
	writeEuroc(folder);
	const auto notes = [&]
	{
		std::string text;
		for (const std::string& note : importEuroc({folder.path(), folder.file("x.rawlog")}).notes) text += note + "\n";
		return text;
	};
	const auto holds = [](const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; };
	const std::string complete = notes();
	EXPECT_TRUE(holds(complete, "acc_walk_m_s3_sqrtHz = 0.003 in the configuration\n")) << complete;
	EXPECT_FALSE(holds(complete, "left out")) << complete;

	for (const auto& [t_ns, file] : {std::pair(300000123LL, "first"), std::pair(700000123LL, "second")})
		ASSERT_TRUE(std::filesystem::remove(folder.file(format("mav0/cam0/data/%lld.png", kStart_ns + t_ns)))) << file;
	write(folder, "mav0/cam1/data.csv", "#t\n");
	write(folder, "mav0/imu0/sensor.yaml",
	      yamlPose({}) + "gyroscope_noise_density: 1.7e-04\ngyroscope_random_walk: .nan\naccelerometer_noise_density: 2e-3\n");
	const std::string told = notes();
	EXPECT_TRUE(holds(told, "left out, as not there: 2 of 21 images, the first is ")) << told;
	EXPECT_TRUE(holds(told, "300000123.png\n")) << told;
	EXPECT_TRUE(holds(told, "cam1 is left out")) << told;
	EXPECT_TRUE(holds(told,
	                  "set gyro_noise_rad_s_sqrtHz = 0.00017, acc_noise_m_s2_sqrtHz = 0.002 in the configuration; the sequence does "
	                  "not say gyro_walk_rad_s2_sqrtHz, acc_walk_m_s3_sqrtHz"))
	    << told;
	EXPECT_EQ(RawlogContent(folder.file("x.rawlog")).images.size(), 19u);
}

TEST(EurocImporter, ReadsEquidistantLenses)
{
	const TempFolder folder;
	writeEuroc(folder);
	write(folder, "mav0/cam0/sensor.yaml",
	      yamlPose({}) +
	          "camera_model: pinhole\nresolution: [64, 48]\nintrinsics: [50, 50, 31, 23]\ndistortion_model: equidistant\n"
	          "distortion_coefficients: [0.1, 0.2, 0.3, 0.4]\n");
	importEuroc({folder.path(), folder.file("x.rawlog")});
	const CameraModel camera = readCalibration(folder.file("x.rawlog"), {}, true, true).camera;
	EXPECT_EQ(camera.distortion(), CameraModel::Distortion::kannala_brandt);
	EXPECT_NEAR(camera.coefficients()[3], 0.4, 1e-9);
}

TEST(EurocImporter, SaysWhatIsWrongInOneLine)
{
	const TempFolder folder;
	const ImportJob job{folder.path(), folder.file("x.rawlog")};
	expectError([&] { importEuroc(job); }, {folder.path(), "not a sequence in EuRoC's layout"});

	writeEuroc(folder);
	const auto damaged = [&](const std::string& name, const std::string& content, std::initializer_list<std::string> parts)
	{
		const std::string before = readFile(folder.file(name));
		write(folder, name, content);
		expectError([&] { importEuroc(job); }, parts);
		write(folder, name, before);
	};
	damaged("mav0/imu0/data.csv", "#t\n1,2,3,4,5,6\n", {"imu0/data.csv:2", "6 columns; expected at least 7"});
	damaged("mav0/imu0/data.csv", "2,2,3,4,5,6,7\n1,2,3,4,5,6,7\n", {"imu0/data.csv:2", "not later"});
	damaged("mav0/imu0/data.csv", "1,2,3,nan,5,6,7\n", {"imu0/data.csv:1", "'nan' is not a finite number"});
	damaged("mav0/imu0/data.csv", "1.5,2,3,4,5,6,7\n", {"imu0/data.csv:1", "'1.5' is not a whole number"});
	damaged("mav0/imu0/data.csv", "#t\n", {"imu0/data.csv", "no data"});
	damaged("mav0/odom0/data.csv", "1,2\n", {"odom0/data.csv:1", "v [m/s]"});
	damaged("mav0/cam0/data.csv", "1,absent.png\n", {"cam0/data.csv", "none of its images", "absent.png", "unpack"});
	damaged("mav0/cam0/sensor.yaml", yamlPose({}) + "camera_model: omni\n", {"cam0/sensor.yaml", "'omni' is not known"});
	damaged("mav0/cam0/sensor.yaml",
	        yamlPose({}) + "camera_model: pinhole\nresolution: [65, 48]\nintrinsics: [50, 50, 31, 23]\ndistortion_model: none\n",
	        {"64x48 pixels", "65x48"});
	damaged("mav0/cam0/sensor.yaml", "T_BS: [1, 2]\n", {"cam0/sensor.yaml: ", "missing"});
	damaged("mav0/imu0/sensor.yaml", "T_BS: [1, 2]\n", {"imu0/sensor.yaml: T_BS", "2 numbers instead of 16"});
	damaged("mav0/imu0/sensor.yaml", "a: [b\n", {"imu0/sensor.yaml:", "not valid YAML"});
	damaged("mav0/odom0/sensor.yaml", "T_BS: [2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n", {"odom0/sensor.yaml: T_BS", "not orthonormal"});
	std::filesystem::remove(folder.file("mav0/imu0/data.csv"));
	expectError([&] { importEuroc(job); }, {"imu0/data.csv", "cannot read"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("x.rawlog")));
}

TEST(EurocImporter, StopsWhenAsked)
{
	const TempFolder folder;
	writeEuroc(folder);
	ImportJob job{folder.path(), folder.file("x.rawlog")};
	job.proceed = [](double fraction) { return fraction < 0.5; };
	expectError([&] { importEuroc(job); }, {"interrupted"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("x.rawlog")));
}

TEST(EurocImporter, SameRecordingGivesSameBytes)
{
	const TempFolder folder;
	writeEuroc(folder);
	importEuroc({folder.path(), folder.file("a.rawlog")});
	importEuroc({folder.path(), folder.file("b.rawlog")});
	EXPECT_EQ(readFile(folder.file("a.rawlog")), readFile(folder.file("b.rawlog")));
	EXPECT_EQ(readFile(folder.file("a_ground_truth.tum")), readFile(folder.file("b_ground_truth.tum")));
}
