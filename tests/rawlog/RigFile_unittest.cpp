#include <mrpt/config/CConfigFile.h>
#include <viwo/core/MrptPose.h>
#include <viwo/rawlog/ObservationAdapter.h>
#include <viwo/rawlog/RigFile.h>

#include <cstdlib>

#include "ExpectError.h"
#include "RawlogFixture.h"

using namespace viwo;
using namespace viwo::testing;
using Distortion = CameraModel::Distortion;

namespace
{
const Pose3 kT_OC(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0.02, 0.31)),
    kT_OB(Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized(), Eigen::Vector3d(-0.05, 0.004, 0.2));

CameraModel lens(Distortion distortion)
{
	if (distortion == Distortion::none) return {320, 200, 210.5, 211.5, 158.25, 99.75};
	if (distortion == Distortion::plumb_bob) return {64, 48, 30.5, 31.5, 32.25, 24.75, distortion, {-0.2, 0.03, 0.001, -0.002, 0.004}};
	return {64, 48, 30.5, 31.5, 32.25, 24.75, distortion, {0.02, -0.01, 0.003, -0.0005, 0}};
}

RigFile wholeRig(Distortion distortion)
{
	RigFile rig{RigCamera(), RigImu(), RigWheels()};
	rig.camera->setModel(lens(distortion));
	rig.camera->mounting.setPose(kT_OC);
	rig.camera->time_offset_s = -0.0125;
	rig.imu->mounting.setPose(kT_OB);
	rig.imu->acc_noise_m_s2_sqrtHz = 0.0016;
	rig.imu->gyro_walk_rad_s2_sqrtHz = 3e-5;
	rig.wheels->left_scale = 1.012;
	rig.wheels->right_scale = 0.995;
	rig.wheels->calibrated_track_m = 0.2312;
	rig.wheels->time_offset_s = 0.02;
	return rig;
}

Pose3 poseOf(const mrpt::obs::CObservation& observation)
{
	mrpt::poses::CPose3D pose;
	observation.getSensorPose(pose);
	return fromMrpt(pose);
}

void expectSame(const Pose3& a, const Pose3& b)
{
	EXPECT_LT((a.p - b.p).norm(), 1e-8);
	EXPECT_LT(a.R.angularDistance(b.R), 1e-8);
}

void expectSame(const CameraModel& a, const CameraModel& b)
{
	EXPECT_EQ(a.width_px(), b.width_px());
	EXPECT_EQ(a.height_px(), b.height_px());
	for (const Eigen::Vector3d& P : {Eigen::Vector3d(0.1, -0.2, 1), Eigen::Vector3d(-0.7, 0.3, 1.2), Eigen::Vector3d(0, 0, 1)})
	{
		const auto pa = a.project(P), pb = b.project(P);
		ASSERT_TRUE(pa && pb);
		EXPECT_LT((*pa - *pb).norm(), 1e-9);
	}
}

class RigFileTest : public RawlogTest
{
   protected:
	const std::string ini = folder.file("rig.ini");
};
}  // namespace

TEST_F(RigFileTest, WhatIsSavedIsLoaded)
{
	for (const Distortion distortion : {Distortion::none, Distortion::plumb_bob, Distortion::kannala_brandt})
	{
		wholeRig(distortion).save(ini, "a rig");
		const RigFile rig = RigFile::load(ini);
		expectSame(rig.camera->model(), lens(distortion));
		expectSame(rig.camera->mounting.pose(), kT_OC);
		expectSame(rig.imu->mounting.pose(), kT_OB);
		EXPECT_EQ(rig.camera->time_offset_s, -0.0125);
		EXPECT_EQ(rig.imu->acc_noise_m_s2_sqrtHz, 0.0016);
		EXPECT_EQ(rig.wheels->calibrated_track_m, 0.2312);
	}
}

TEST_F(RigFileTest, MrptReadsTheCameraAsWeDo)
{
	for (const Distortion distortion : {Distortion::none, Distortion::plumb_bob, Distortion::kannala_brandt})
	{
		wholeRig(distortion).save(ini, "a rig");
		mrpt::img::TCamera camera;
		camera.loadFromConfigFile("CAMERA_PARAMS", mrpt::config::CConfigFile(ini));
		expectSame(fromMrpt(camera), lens(distortion));
	}
}

TEST_F(RigFileTest, PutIntoARawlogByRawlogEditIsTheSameAsGivenBesideIt)
{
	writeSecond(path, false);
	wholeRig(Distortion::plumb_bob).save(ini, "a rig");
	const std::string posed = folder.file("posed.rawlog"), ready = folder.file("ready.rawlog");
	if (std::system("which rawlog-edit > /dev/null 2>&1") != 0) GTEST_SKIP() << "rawlog-edit is not installed";
	const auto edit = [&](const std::string& options) { return std::system(("rawlog-edit " + options + " > /dev/null 2>&1").c_str()); };
	ASSERT_EQ(edit("--sensors-pose " + ini + " -i " + path + " -o " + posed), 0);
	ASSERT_EQ(edit("--camera-params CAM," + ini + " -i " + posed + " -o " + ready), 0);

	RawlogReaderOptions options;
	options.rig = std::make_shared<RigFile>(RigFile::load(ini));
	const auto beside = readAll(path, options), edited = readAll(ready);
	ASSERT_EQ(beside.size(), edited.size());
	for (size_t i = 0; i < beside.size(); ++i)
	{
		expectSame(poseOf(*beside[i]), poseOf(*edited[i]));
		const auto a = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(beside[i]),
		           b = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(edited[i]);
		ASSERT_EQ(!a, !b);
		if (a) expectSame(fromMrpt(a->cameraParams), fromMrpt(b->cameraParams));
	}
	const Calibration calibration = readCalibration({path}, AdapterOptions(), true, true, false, options.rig.get());
	expectSame(calibration.T_OC, kT_OC);
	expectSame(calibration.T_OB, kT_OB);
	expectSame(calibration.camera, lens(Distortion::plumb_bob));
}

TEST_F(RigFileTest, OtherLabelsStayAsTheyAre)
{
	writeSecond(path, false);
	RigFile rig = wholeRig(Distortion::none);
	rig.camera->mounting.label = "LEFT";
	rig.imu.reset();
	RawlogReaderOptions options;
	options.rig = std::make_shared<RigFile>(rig);
	const auto with = readAll(path, options), without = readAll(path);
	for (size_t i = 0; i < with.size(); ++i) expectSame(poseOf(*with[i]), poseOf(*without[i]));
}

TEST_F(RigFileTest, BadFilesAreToldInOneLine)
{
	expectError([&] { RigFile::load(folder.file("none.ini")); }, {"none.ini"});
	writeFile(ini, "[CAMERA]\nfx = 3\n");
	expectError([&] { RigFile::load(ini); }, {"rig.ini", "CAMERA"});
	writeFile(ini, "");
	expectError([&] { RigFile::load(ini); }, {"rig.ini", "no calibration", "[IMU]"});
	writeFile(ini, "[CAMERA_PARAMS]\nresolution = 640 480\nfx = 0\nfy = 300\n");
	expectError([&] { RigFile::load(ini); }, {"rig.ini", "focal length"});
	writeFile(ini, "[CAMERA_PARAMS]\nresolution = 640\nfx = 300\nfy = 300\n");
	expectError([&] { RigFile::load(ini); }, {"rig.ini", "resolution", "640 480"});
	writeFile(ini, "[CAMERA_PARAMS]\nresolution = 640 480\nfx = 300\nfy = 300\ndistortion_model = kannala_brandt\ndist = 1 2 3 4 5\n");
	expectError([&] { RigFile::load(ini); }, {"rig.ini", "dist", "5 coefficients"});
	writeFile(ini, "[IMU]\nacc_noise = 3\n");
	expectError([&] { RigFile::load(ini); }, {"rig.ini", "acc_noise", "unknown key"});
}
