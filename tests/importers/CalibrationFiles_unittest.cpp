#include <gtest/gtest.h>
#include <viwo/core/MrptPose.h>
#include <viwo/importers/CalibrationFiles.h>

#include <opencv2/calib3d.hpp>

#include <cmath>

#include "ExpectError.h"
#include "ImuNoise.h"
#include "RunProgram.h"

namespace viwo::testing
{
namespace
{
constexpr const char* kCamchain =
    "cam0:\n"
    "  camera_model: pinhole\n"
    "  intrinsics: [461.629, 460.152, 362.680, 246.049]\n"
    "  distortion_model: radtan\n"
    "  distortion_coeffs: [-0.27695497, 0.06712482, 0.00087538, 0.00011556]\n"
    "  T_cam_imu:\n"
    "  - [0.0, -1.0, 0.0, 0.07]\n"
    "  - [0.0, 0.0, -1.0, -0.02]\n"
    "  - [1.0, 0.0, 0.0, -0.05]\n"
    "  - [0.0, 0.0, 0.0, 1.0]\n"
    "  timeshift_cam_imu: -0.0081\n"
    "  rostopic: /cam0/image_raw\n"
    "  resolution: [752, 480]\n"
    "cam1:\n"
    "  camera_model: pinhole\n"
    "  intrinsics: [311.5, 312.5, 320.5, 239.5]\n"
    "  distortion_model: equidistant\n"
    "  distortion_coeffs: [-0.011, 0.006, -0.004, 0.0007]\n"
    "  rostopic: /cam1/image_raw\n"
    "  resolution: [640, 480]\n"
    "cam2:\n"
    "  camera_model: omni\n"
    "  intrinsics: [0.8, 833.0, 830.3, 373.8, 253.7]\n"
    "  distortion_model: radtan\n"
    "  distortion_coeffs: [-0.3, 0.1, 0.0005, 0.0005]\n"
    "  resolution: [752, 480]\n";

constexpr const char* kImu =
    "accelerometer_noise_density: 0.0018\n"
    "accelerometer_random_walk: 0.0006\n"
    "gyroscope_noise_density: 0.00024\n"
    "gyroscope_random_walk: 2.6e-05\n"
    "rostopic: /imu0\n"
    "update_rate: 200.0\n";

class CalibrationFilesTest : public ::testing::Test
{
   protected:
	CalibrationFiles kalibr(const std::string& camera = "cam0")
	{
		CalibrationFiles files;
		files.kalibr_camchain = write(folder_, "camchain.yaml", kCamchain);
		files.kalibr_camera = camera;
		return files;
	}
	/** The file with one of its words replaced. */
	static std::string replaced(std::string text, const std::string& word, const std::string& by)
	{
		return text.replace(text.find(word), word.size(), by);
	}

	const TempFolder folder_;
};

/** Against OpenCV's own projection, to a millionth of a pixel. */
void expectProjectsAs(const CameraModel& model, bool fisheye, double fx, double fy, double cx, double cy, const std::vector<double>& k)
{
	const cv::Matx33d K(fx, 0, cx, 0, fy, cy, 0, 0, 1);
	std::vector<cv::Point3d> points;
	for (double x = -0.6; x <= 0.6; x += 0.2)
		for (double y = -0.4; y <= 0.4; y += 0.2) points.emplace_back(x, y, 1.1);
	std::vector<cv::Point2d> pixels;
	if (fisheye)
		cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), K, k);
	else
		cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K, k, pixels);
	double worst_px = 0;
	for (size_t i = 0; i < points.size(); ++i)
	{
		const auto pixel = model.project({points[i].x, points[i].y, points[i].z});
		ASSERT_TRUE(pixel);
		worst_px = std::max(worst_px, (*pixel - Eigen::Vector2d(pixels[i].x, pixels[i].y)).norm());
	}
	std::cout << "[measured] largest difference to OpenCV's projection " << worst_px << " px\n";
	EXPECT_LT(worst_px, 1e-6);
}

TEST_F(CalibrationFilesTest, KalibrNumbersByHand)
{
	CalibrationFiles files = kalibr();
	files.kalibr_imu = write(folder_, "imu.yaml", kImu);
	// The IMU looks as the robot does and sits at (0.2, 0, 0.4) on it.
	files.T_BO = Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.2, 0, -0.4));
	const ImportedRig imported = importCalibration(files);
	EXPECT_TRUE(imported.warnings.empty());
	const RigFile& rig = imported.rig;
	// p_C = R p_B + t: the camera's origin in B is -R^T t = -(z, -x, -y) of t = (0.05, 0.07, -0.02).
	const Pose3 T_OC = rig.camera->mounting.pose();
	EXPECT_LT((T_OC.p - Eigen::Vector3d(0.2 + 0.05, 0.07, 0.4 - 0.02)).norm(), 1e-9);
	EXPECT_LT(T_OC.R.angularDistance(forwardOpticalAxes()), 1e-9);
	EXPECT_NEAR(rig.camera->mounting.yaw_deg, -90, 1e-6);
	EXPECT_NEAR(rig.camera->mounting.roll_deg, -90, 1e-6);
	EXPECT_LT((rig.imu->mounting.pose().p - Eigen::Vector3d(0.2, 0, 0.4)).norm(), 1e-9);
	EXPECT_EQ(rig.camera->time_offset_s, -0.0081) << "t_imu = t_cam + timeshift";
	EXPECT_EQ(rig.imu->acc_noise_m_s2_sqrtHz, 0.0018);
	EXPECT_EQ(rig.imu->gyro_noise_rad_s_sqrtHz, 0.00024);
	EXPECT_EQ(rig.imu->acc_walk_m_s3_sqrtHz, 0.0006);
	EXPECT_EQ(rig.imu->gyro_walk_rad_s2_sqrtHz, 2.6e-5);
	expectProjectsAs(rig.camera->model(), false, 461.629, 460.152, 362.680, 246.049, {-0.27695497, 0.06712482, 0.00087538, 0.00011556});
}

TEST_F(CalibrationFilesTest, KalibrFisheye)
{
	const ImportedRig imported = importCalibration(kalibr("cam1"));
	expectProjectsAs(imported.rig.camera->model(), true, 311.5, 312.5, 320.5, 239.5, {-0.011, 0.006, -0.004, 0.0007});
	EXPECT_FALSE(imported.rig.imu) << "no T_cam_imu, no imu.yaml";
	EXPECT_EQ(imported.warnings.size(), 1u) << "the mounting is not known";
}

TEST_F(CalibrationFilesTest, WithoutTheRobotsPoseTheCameraLooksAhead)
{
	const ImportedRig imported = importCalibration(kalibr());
	const Pose3 T_OC = imported.rig.camera->mounting.pose(), T_OB = imported.rig.imu->mounting.pose();
	EXPECT_LT(T_OC.R.angularDistance(forwardOpticalAxes()), 1e-9);
	EXPECT_LT(((T_OC.inverse() * T_OB).p - Eigen::Vector3d(0.07, -0.02, -0.05)).norm(), 1e-9) << "T_CB is kept";
	ASSERT_EQ(imported.warnings.size(), 1u);
	EXPECT_NE(imported.warnings[0].find("--odom"), std::string::npos);
}

TEST_F(CalibrationFilesTest, RosAndMrptCameras)
{
	CalibrationFiles ros;
	ros.ros_camera_info = write(folder_, "left.yaml",
	                            "image_width: 640\nimage_height: 480\ncamera_name: left\n"
	                            "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [401.5, 0, 318.25, 0, 402.5, 241.75, 0, 0, 1]\n"
	                            "distortion_model: plumb_bob\n"
	                            "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.3, 0.1, 0.0005, -0.0002, 0.01]\n");
	expectProjectsAs(importCalibration(ros).rig.camera->model(), false, 401.5, 402.5, 318.25, 241.75, {-0.3, 0.1, 0.0005, -0.0002, 0.01});

	CalibrationFiles mrpt;
	mrpt.mrpt_camera = write(folder_, "camera.ini",
	                         "[CAMERA_PARAMS]\nresolution = [640 480]\ncx = 318.25\ncy = 241.75\nfx = 401.5\nfy = 402.5\n"
	                         "dist = [-0.3 0.1 0.0005 -0.0002 0.01]\nfocal_length = 0.00356\n");
	expectProjectsAs(importCalibration(mrpt).rig.camera->model(), false, 401.5, 402.5, 318.25, 241.75, {-0.3, 0.1, 0.0005, -0.0002, 0.01});

	EXPECT_EQ(readFile(mrpt.mrpt_camera).find("distortion_model"), std::string::npos) << "the user's file stays as it is";

	// What MRPT itself writes, and reads.
	CalibrationFiles fisheye;
	fisheye.mrpt_camera =
	    write(folder_, "fisheye.ini",
	          "[CAMERA_PARAMS]\ncamera_name = camera1\nresolution = [640 480]\ncx = 318.25\ncy = 241.75\nfx = 401.5\nfy = 402.5\n"
	          "distortion_model = kannala_brandt\ndist = [-1.1e-02 6.0e-03 -4.0e-03 7.0e-04 ]\n");
	expectProjectsAs(importCalibration(fisheye).rig.camera->model(), true, 401.5, 402.5, 318.25, 241.75, {-0.011, 0.006, -0.004, 0.0007});

	mrpt.ros_camera_info = ros.ros_camera_info;
	expectError([&] { importCalibration(mrpt); }, {"more than one file"});
}

TEST_F(CalibrationFilesTest, ImplausibleNoiseIsTold)
{
	const auto warningsOf = [&](const std::string& word, const std::string& by)
	{
		CalibrationFiles files = kalibr();
		files.T_BO = Pose3();
		files.kalibr_imu = write(folder_, "imu.yaml", replaced(kImu, word, by));
		return importCalibration(files).warnings;
	};
	EXPECT_TRUE(warningsOf("0.0018", "0.0018").empty());
	const auto discrete = warningsOf("0.0018", "0.0255");
	ASSERT_EQ(discrete.size(), 1u);
	EXPECT_NE(discrete[0].find("single samples"), std::string::npos) << discrete[0];
	EXPECT_NE(discrete[0].find("0.0018"), std::string::npos) << discrete[0];
	const auto wrong_unit = warningsOf("0.00024", "0.5");
	ASSERT_EQ(wrong_unit.size(), 1u);
	EXPECT_NE(wrong_unit[0].find("check its unit"), std::string::npos) << wrong_unit[0];
	EXPECT_EQ(doubtOnNoise("x", 1e-3, 1e-5, 1e-2, 0), "");
}

TEST_F(CalibrationFilesTest, AModelOfTheImusAxesIsSaidNotToBeApplied)
{
	const auto warningsOf = [&](const std::string& more)
	{
		CalibrationFiles files = kalibr();
		files.T_BO = Pose3();
		files.kalibr_imu = write(folder_, "imu.yaml", std::string(kImu) + more);
		return importCalibration(files).warnings;
	};
	EXPECT_TRUE(warningsOf("model: calibrated\n").empty());
	const auto scaled = warningsOf(
	    "accelerometers:\n  M:\n  - [1.03, 0, 0]\n  - [0.02, 0.98, 0]\n  - [0, 0, 1]\n"
	    "gyroscopes:\n  M: [[1, 0, 0], [0, 1, 0], [-0.04, 0, 1]]\nmodel: scale-misalignment\n");
	ASSERT_EQ(scaled.size(), 1u);
	for (const char* part : {"imu.yaml: model: scale-misalignment", "only the noise is taken", "0.04 from the identity", "not applied"})
		EXPECT_NE(scaled[0].find(part), std::string::npos) << scaled[0];
}

TEST_F(CalibrationFilesTest, BadFilesAreToldInOneLine)
{
	expectError([&] { importCalibration(kalibr("cam2")); }, {"camchain.yaml", "cam2: camera_model", "omni", "pinhole-radtan"});
	expectError([&] { importCalibration(kalibr("cam7")); }, {"camchain.yaml", "cam7", "cam0, cam1, cam2"});
	const auto expectBad = [&](const std::string& word, const std::string& by, std::initializer_list<std::string> parts)
	{
		CalibrationFiles files = kalibr();
		write(folder_, "camchain.yaml", replaced(kCamchain, word, by));
		expectError([&] { importCalibration(files); }, parts);
	};
	expectBad("[461.629, 460.152, 362.680, 246.049]", "[461.629, 460.152, 362.680]", {"cam0: intrinsics", "3 numbers instead of 4"});
	expectBad("cam0:", "cam8:", {"cam0", "it has cam1, cam2, cam8"});
	expectBad("461.629", "-461.629", {"cam0: intrinsics", "focal length"});
	expectBad("[0.0, -1.0, 0.0, 0.07]", "[0.0, -1.1, 0.0, 0.07]", {"cam0: T_cam_imu", "orthonormal"});
	expectBad("radtan", "fov", {"cam0: distortion_model", "fov"});
	for (const char* number : {"soon", ".nan", "-.inf"})
		expectBad("-0.0081", number, {"cam0: timeshift_cam_imu", number, "not a finite number"});
	for (const char* number : {"12", "-1e300"})
		expectBad("-0.0081", number, {"camchain.yaml: cam0: timeshift_cam_imu", "between -10 and 10 s"});
	expectBad("362.680", "3626.80", {"camchain.yaml: cam0: intrinsics", "cx 3626.8", "752 x 480"});
	expectBad("461.629, 460.152", "3, 3", {"cam0: intrinsics", "fx 3.0"});
	expectBad("[752, 480]", "[752.5, 480]", {"cam0: resolution", "whole pixels"});
	expectBad("[752, 480]", "[0, 480]", {"cam0: resolution", "whole pixels"});
	expectBad("[0.0, 0.0, 0.0, 1.0]", "[0.04, 0.0, 0.0, 0.5]", {"camchain.yaml: cam0: T_cam_imu", "last row", "0 0 0 1"});
	expectBad("cam0:", "cam0: [", {"camchain.yaml", "not valid YAML"});
	const auto expectBadRos = [&](const std::string& width, const std::string& cx, std::initializer_list<std::string> parts)
	{
		CalibrationFiles files;
		files.ros_camera_info = write(folder_, "left.yaml",
		                              "image_width: " + width + "\nimage_height: 480\ncamera_matrix:\n  data: [401.5, 0, " + cx +
		                                  ", 0, 402.5, 241.75, 0, 0, 1]\ndistortion_model: plumb_bob\n"
		                                  "distortion_coefficients:\n  data: [0, 0, 0, 0, 0]\n");
		expectError([&] { importCalibration(files); }, parts);
	};
	expectBadRos("640", "3182.5", {"left.yaml: camera_matrix", "cx 3182.5", "640 x 480"});
	expectBadRos("640.5", "318.25", {"left.yaml: image_width, image_height", "whole pixels"});
	CalibrationFiles files;
	expectError([&] { importCalibration(files); }, {"no calibration file"});
	files.kalibr_imu = write(folder_, "imu.yaml", replaced(kImu, "0.00024", "-1"));
	expectError([&] { importCalibration(files); }, {"imu.yaml", "gyroscope_noise_density", "above 0"});
	files = CalibrationFiles();
	files.mrpt_camera = folder_.file("none.ini");
	expectError([&] { importCalibration(files); }, {"none.ini", "camera-calib"});
}

TEST_F(CalibrationFilesTest, ProgramWritesARigAndFailsInOneLine)
{
	const std::string program = VIWO_BINARY_DIR "/bin/viwo-calibrate", rig = folder_.file("rig.ini");
	kalibr();
	const std::vector<std::string> arguments{
	    "import", "--kalibr", folder_.file("camchain.yaml"), "--odom", "-0.2", "0", "-0.4", "0", "0", "0", "-o", rig};
	const ProgramResult result = runProgram(program, arguments);
	ASSERT_EQ(result.status, 0) << result.err;
	EXPECT_EQ(result.errorLines(), 0u) << result.err;
	EXPECT_NEAR(RigFile::load(rig).camera->mounting.x_m, 0.25, 1e-9);
	const std::string bytes = readFile(rig);
	ASSERT_EQ(runProgram(program, arguments).status, 0);
	EXPECT_EQ(readFile(rig), bytes);

	// What help and manual say of these numbers.
	for (const auto& [odom, R_OB] :
	     {std::pair(std::vector<std::string>{"0", "0.3", "-0.1", "90", "-90", "0"}, forwardOpticalAxes()),
	      std::pair(std::vector<std::string>{"-0.1", "0", "-0.3", "0", "0", "0"}, Eigen::Quaterniond::Identity())})
	{
		std::vector<std::string> told{"import", "--kalibr", folder_.file("camchain.yaml"), "-o", folder_.file("told.ini"), "--odom"};
		told.insert(told.end(), odom.begin(), odom.end());
		ASSERT_EQ(runProgram(program, told).status, 0);
		const Pose3 T_OB = RigFile::load(folder_.file("told.ini")).imu->mounting.pose();
		EXPECT_LT((T_OB.p - Eigen::Vector3d(0.1, 0, 0.3)).norm(), 1e-9);
		EXPECT_LT(T_OB.R.angularDistance(R_OB), 1e-9);
	}

	const ProgramResult refused = runProgram(program, {"import", "--kalibr", folder_.file("camchain.yaml"), "--camera", "cam2", "-o", rig});
	EXPECT_EQ(refused.status, 1);
	EXPECT_EQ(refused.errorLines(), 1u) << refused.err;
	EXPECT_EQ(readFile(rig), bytes) << "the earlier file stays";
	EXPECT_EQ(runProgram(program, {"import", "-o", rig}).status, 2);
	EXPECT_EQ(runProgram(program, {}).status, 2);
}
}  // namespace
}  // namespace viwo::testing
