#include <viwo/rawlog/ObservationAdapter.h>
#include <viwo/rawlog/RigFile.h>

#include "EditedLog.h"
#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
class CalibrateProgram : public ::testing::Test
{
   protected:
	ProgramResult estimate(std::vector<std::string> options) const
	{
		options.insert(options.begin(), {"estimate", "-o", folder_.file("rig.ini")});
		return runProgram(program("viwo-calibrate"), options);
	}

	void expectError(const std::vector<std::string>& options, const std::string& part) const
	{
		const ProgramResult result = estimate(options);
		EXPECT_EQ(result.status, 1) << part;
		EXPECT_EQ(result.errorLines(), 1u) << result.err;
		EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
		EXPECT_FALSE(std::filesystem::exists(folder_.file("rig.ini")));
	}

	const TempFolder folder_;
};

TEST_F(CalibrateProgram, WritesARigWithDeviationsAndAReport)
{
	const TestLog log = testLog(corridorTestDrive());
	const ProgramResult result = estimate({"-i", log.rawlog, "--html", folder_.file("report.html"), "--json"});
	ASSERT_EQ(result.status, 0) << result.err;
	EXPECT_EQ(result.err, "");
	const RigFile rig = RigFile::load(folder_.file("rig.ini"));
	ASSERT_TRUE(rig.camera && rig.imu && rig.wheels);
	const Json json = Json::parse(result.out);
	EXPECT_FALSE(json["parameters"]["imu_z"]["observed"].get<bool>());
	EXPECT_NEAR(json["parameters"]["imu_z"]["value"].get<double>(), 1e3 * rig.imu->mounting.z_m, 1e-3);
	EXPECT_NEAR(json["parameters"]["left_scale"]["value"].get<double>(), rig.wheels->left_scale, 1e-6);
	EXPECT_TRUE(json["parameters"]["track"]["observed"].get<bool>());
	EXPECT_LE(json["residuals_after"]["wheel_yaw_mrad"].get<double>(), json["residuals_before"]["wheel_yaw_mrad"].get<double>());
	EXPECT_NE(readFile(folder_.file("rig.ini")).find("# Standard deviations"), std::string::npos);
	const std::string html = readFile(folder_.file("report.html"));
	for (const char* part : {"<!DOCTYPE html>", "not observed (input kept)", "Residuals before and after", "<svg"})
		EXPECT_NE(html.find(part), std::string::npos) << part;
	EXPECT_EQ(html.find("http://www.w3.org/1999/xhtml"), std::string::npos);
}

TEST_F(CalibrateProgram, SameBytesAgainAndARigThatRawlogEditTakes)
{
	const TestLog log = testLog(corridorTestDrive());
	ASSERT_EQ(estimate({"-i", log.rawlog, "--quiet"}).status, 0);
	const std::string first = readFile(folder_.file("rig.ini"));
	ASSERT_EQ(estimate({"-i", log.rawlog, "--quiet"}).status, 0);
	EXPECT_EQ(readFile(folder_.file("rig.ini")), first);

	if (runProgram("sh", {"-c", "command -v rawlog-edit"}).status != 0) GTEST_SKIP() << "no rawlog-edit here (Debian package mrpt-apps)";
	const std::string copy =
	    editedLog(log.rawlog, folder_, 1, [](auto& observation, double, RawlogWriter& writer) { writer.write(observation); });
	const std::string options = " && rawlog-edit --sensors-pose rig.ini -i " + copy +
	                            " -o posed.rawlog && rawlog-edit --camera-params CAM,rig.ini "
	                            "-i posed.rawlog -o ready.rawlog";
	const ProgramResult edited = runProgram("sh", {"-c", "cd " + folder_.path() + options});
	ASSERT_EQ(edited.status, 0) << edited.err;
	const RigFile rig = RigFile::load(folder_.file("rig.ini"));
	const Calibration found = readCalibration({folder_.file("ready.rawlog")}, AdapterOptions(), true, true, false, nullptr);
	EXPECT_LT((found.T_OC.p - rig.camera->mounting.pose().p).norm(), 1e-6);
	EXPECT_LT(found.T_OC.R.angularDistance(rig.camera->mounting.pose().R), 1e-6);
	EXPECT_LT((found.T_OB.p - rig.imu->mounting.pose().p).norm(), 1e-6);
	EXPECT_NEAR(found.camera.fx_px(), rig.camera->fx_px, 1e-6);
}

TEST_F(CalibrateProgram, ARigThatDoesNotFitIsNamed)
{
	const TestLog log = testLog(corridorTestDrive());
	const std::string label = write(folder_, "label.ini", "[IMU]\nsensorLabel = XSENS\n");
	expectError({"-i", log.rawlog, "--rig", label}, "label.ini: the rig is that of label XSENS");
	const std::string pose = write(folder_, "pose.ini", "[CAMERA_PARAMS]\nsensorLabel = CAM\nresolution = 640 480\nfx = 300\nfy = 300\n");
	expectError({"-i", log.rawlog, "--rig", pose}, "pose.ini: camera CAM has no pose");
}

TEST_F(CalibrateProgram, BadInputIsOneLine)
{
	const TestLog log = testLog(corridorTestDrive());
	expectError({"-i", folder_.file("none.rawlog")}, "none.rawlog");
	expectError({"-i", log.rawlog, "-t", folder_.file("none.tum")}, "none.tum");
	expectError({"-i", log.rawlog, "--rig", folder_.file("none.ini")}, "none.ini");
	const std::string wheels = write(folder_, "wheels.ini", "[rawlog]\nodometry_label = BASE\n");
	expectError({"-i", log.rawlog, "-c", wheels}, "under label BASE");
	const std::string camera = write(folder_, "camera.ini", "[rawlog]\ncam_label = EYE\n");
	expectError({"-i", log.rawlog, "-c", camera}, "under label EYE");
	const std::string key = write(folder_, "key.ini", "[calibration]\nacc_scal = 0.001\n");
	expectError({"-i", log.rawlog, "-c", key}, "acc_scal");
}
}  // namespace
}  // namespace viwo::testing
