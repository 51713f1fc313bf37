#include <viwo/calibration/CalibrationRun.h>
#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/ObservationAdapter.h>
#include <viwo/rawlog/RigFile.h>

#include <regex>

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
	// Noise of the wheels grows with the size that they are found to have, here by 1 to 2 %.
	for (const char* kind : {"image_px", "wheel_yaw_mrad", "wheel_forward_mm"})
	{
		const double before = json["residuals_before"][kind], after = json["residuals_after"][kind];
		std::cout << "[measured] " << kind << " before " << before << ", after " << after << "\n";
		EXPECT_LT(after, 1.03 * before) << kind;
	}
	EXPECT_NE(readFile(folder_.file("rig.ini")).find("# Standard deviations"), std::string::npos);
	const std::string html = readFile(folder_.file("report.html"));
	for (const char* part : {"<!DOCTYPE html>", "<td>not observed</td>", "Residuals before and after", "<svg"})
		EXPECT_NE(html.find(part), std::string::npos) << part;
	EXPECT_EQ(html.find("http://www.w3.org/1999/xhtml"), std::string::npos);
}

TEST_F(CalibrateProgram, PrintsAWholeTableAndTheFilesWritten)
{
	const TestLog log = testLog(corridorTestDrive());
	const std::string link = folder_.file(std::string(200, 'x')), html = folder_.file("report.html");
	std::filesystem::create_directory_symlink(std::filesystem::absolute(log.rawlog).parent_path(), link);
	const std::string rawlog = link + "/" + std::filesystem::path(log.rawlog).filename().string();
	const ProgramResult result = estimate({"-i", rawlog, "--html", html});
	ASSERT_EQ(result.status, 0) << result.err;
	const std::string first = result.out.substr(0, result.out.find('\n'));
	EXPECT_NE(first.find(" of " + rawlog + ": "), std::string::npos) << first;
	EXPECT_NE(first.find(" times the configured, slip "), std::string::npos) << first;
	const std::string files = "\n" + folder_.file("rig.ini") + "\n" + html + "\n";
	ASSERT_GT(result.out.size(), files.size());
	EXPECT_EQ(result.out.substr(result.out.size() - files.size()), files);
	std::smatch height;
	ASSERT_TRUE(
	    std::regex_search(result.out, height, std::regex("camera from IMU, z \\(up\\) +mm +(-?[0-9.]+) +(-?[0-9.]+) +not observed ")));
	EXPECT_NE(height[1].str().find('.'), std::string::npos) << "a millimetre is too coarse to measure by";
	EXPECT_EQ(height[1], height[2]);
}

TEST_F(CalibrateProgram, AResultThatCannotBeWrittenIsPrintedAllTheSame)
{
	const TestLog log = testLog(corridorTestDrive());
	const ProgramResult result = runProgram(program("viwo-calibrate"), {"estimate", "-i", log.rawlog, "-o", "/dev/full"});
	EXPECT_EQ(result.status, 1);
	EXPECT_EQ(result.errorLines(), 1u) << result.err;
	EXPECT_NE(result.err.find("/dev/full"), std::string::npos) << result.err;
	EXPECT_NE(result.out.find("left wheel, true over nominal radius"), std::string::npos) << result.out;
}

TEST_F(CalibrateProgram, APartOfALogAndOtherLabels)
{
	const TestLog log = testLog(corridorTestDrive());
	const Trajectory truth = Trajectory::loadTum(log.ground_truth);
	const double length_s = secondsBetween(truth.poses().front().t_ns, truth.poses().back().t_ns);
	const ProgramResult part = estimate({"-i", log.rawlog, "--json", "--from", "0.8", "--to", std::to_string(length_s - 0.2)});
	ASSERT_EQ(part.status, 0) << part.err;
	const double duration_s = Json::parse(part.out)["duration_s"].get<double>();
	std::cout << "[measured] " << duration_s << " s of " << length_s << "\n";
	EXPECT_NEAR(duration_s, length_s - 1, 0.15);
	EXPECT_EQ(Json::parse(part.out)["from_s"].get<double>(), 0.8);
	EXPECT_NE(readFile(folder_.file("rig.ini")).find(log.rawlog + " from 0.8 s on.\n"), std::string::npos) << "the head says what was used";
	std::filesystem::remove(folder_.file("rig.ini"));
	expectError({"-i", log.rawlog, "--from", "1000"}, "not all there between --from and --to");
	expectError({"-i", log.rawlog, "--imu-label", "XSENS"}, "under label XSENS");
	expectError({"-i", log.rawlog, "--odometry-label", "BASE"}, "under label BASE");
	EXPECT_EQ(estimate({"-i", log.rawlog, "--from", "3", "--to", "2"}).status, 2);
}

TEST_F(CalibrateProgram, APipeCannotBeReadTwice)
{
	const ProgramResult result = estimate({"-i", "-"});
	EXPECT_EQ(result.status, 2);
	EXPECT_NE(result.err.find("more than once"), std::string::npos) << result.err;
}

TEST_F(CalibrateProgram, InterruptedAnywhereNothingWasWritten)
{
	const TestLog log = testLog(corridorTestDrive());
	for (const double at : {0.2, 0.6})
	{
		double done = 0;
		CalibrationRunHooks hooks;
		hooks.progress = [&](double fraction, const std::string&) { done = fraction; };
		hooks.interrupted = [&] { return done >= at; };
		CalibrationRunOptions options;
		options.rawlogs = {log.rawlog};
		try
		{
			runCalibration(options, hooks);
			FAIL() << "went on";
		}
		catch (const Error& e)
		{
			EXPECT_NE(std::string(e.what()).find(": interrupted, nothing was written"), std::string::npos) << e.what();
		}
	}
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

TEST_F(CalibrateProgram, WhatIsWrongWithAReferenceIsTold)
{
	const TestLog log = testLog(corridorTestDrive());
	const Trajectory truth = Trajectory::loadTum(log.ground_truth);
	const auto saved = [&](const std::string& name, int64_t period_ns, int64_t shift_ns)
	{
		Trajectory thinned;
		for (const StampedPose& pose : truth.poses())
			if (thinned.empty() || pose.t_ns + shift_ns - thinned.poses().back().t_ns >= period_ns)
				thinned.push_back({pose.t_ns + shift_ns, pose.T});
		thinned.saveTum(folder_.file(name));
		return folder_.file(name);
	};
	expectError({"-i", log.rawlog, "-t", saved("slow.tum", nanoseconds(1), 0)}, "poses are more than 0.5 s apart; give two a second");
	expectError({"-i", log.rawlog, "-t", saved("late.tum", 0, nanoseconds(1000))},
	            "covers 0 % of the log; it must have stamps of the same");
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
