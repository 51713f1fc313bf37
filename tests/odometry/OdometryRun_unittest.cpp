#include <gtest/gtest.h>
#include <viwo/odometry/OdometryRun.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "DrivenLog.h"
#include "ExpectError.h"

namespace viwo
{
namespace
{
using viwo::testing::DrivenLog;
using viwo::testing::TempFolder;

class OdometryRun : public ::testing::Test
{
   protected:
	OdometryRunOptions options()
	{
		OdometryRunOptions o;
		o.rawlog = log_.rawlog;
		o.output_dir = folder_.file("out");
		o.odometry.estimator.mode = Mode::wio;
		return o;
	}
	nlohmann::json summary() const { return nlohmann::json::parse(std::ifstream(folder_.file("out/summary.json"))); }

	const DrivenLog log_{"straight 0.6 m, rotate 20 deg"};
	const TempFolder folder_;
};

TEST_F(OdometryRun, WritesAllOutputsAndReportsProgress)
{
	double last = 0;
	size_t lines = 0;
	OdometryRunHooks hooks;
	hooks.progress = [&](double fraction, const std::string& note)
	{
		EXPECT_GE(fraction, last);
		EXPECT_LE(fraction, 1);
		EXPECT_FALSE(note.empty());
		last = fraction;
	};
	hooks.log = [&](const std::string& line) { lines += !line.empty(); };
	const OdometryRunResult result = runOdometry(options(), hooks);
	EXPECT_GT(last, 0.9);
	EXPECT_GE(lines, 1u);
	EXPECT_EQ(result.left_out, "");
	for (const char* name :
	     {"trajectory.tum", "trajectory_imu_rate.tum", "trajectory_covariance.csv", "landmarks.ply", "summary.json", "config.ini"})
		EXPECT_TRUE(std::filesystem::exists(folder_.file("out") + "/" + name)) << name;
	EXPECT_EQ(Trajectory::loadTum(folder_.file("out/trajectory.tum")).size(), static_cast<size_t>(result.poses));
	EXPECT_EQ(summary().at("poses"), result.poses);
	EXPECT_TRUE(summary().at("gaps").empty());
	EXPECT_GT(summary().at("minutes").at(0).at("frame_median_ms").get<double>(), 0);
	EXPECT_EQ(summary().at("first_pose").at("v_WB_in_B_m_s").size(), 3u);
}

TEST_F(OdometryRun, InterruptionLeavesValidFilesUpToThere)
{
	int frames = 0;
	OdometryRunHooks hooks;
	hooks.progress = [&](double, const std::string&) { ++frames; };
	hooks.interrupted = [&] { return frames >= 30; };
	const OdometryRunResult result = runOdometry(options(), hooks);
	EXPECT_TRUE(result.interrupted);
	EXPECT_GE(result.frames, 30);
	EXPECT_LE(result.frames, 35);
	EXPECT_EQ(Trajectory::loadTum(folder_.file("out/trajectory.tum")).size(), static_cast<size_t>(result.poses));
	EXPECT_EQ(summary().at("interrupted"), true);
}

TEST_F(OdometryRun, LogTooShortForAPose)
{
	OdometryRunOptions o = options();
	o.to_s = 0.2;
	viwo::testing::expectError([&] { runOdometry(o); }, {o.rawlog, "no pose"});
}

TEST_F(OdometryRun, EarlierResultsStayUntilNewOnesAreWhole)
{
	runOdometry(options());
	const std::string before = viwo::testing::readFile(folder_.file("out/trajectory.tum"));
	OdometryRunOptions o = options();
	o.rawlog = folder_.file("none.rawlog");
	viwo::testing::expectError([&] { runOdometry(o); }, {"none.rawlog"});
	EXPECT_EQ(viwo::testing::readFile(folder_.file("out/trajectory.tum")), before);
}
}  // namespace
}  // namespace viwo
