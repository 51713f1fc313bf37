#include <gtest/gtest.h>
#include <viwo/core/Time.h>
#include <viwo/odometry/OdometryRun.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
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
		o.rawlogs = {log_.rawlog};
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
	for (const char* name : {"trajectory.tum", "trajectory_imu_rate.tum", "trajectory_covariance.csv", "landmarks.ply",
	                         "landmark_observations.csv", "keyframes.csv", "summary.json", "config.ini"})
		EXPECT_TRUE(std::filesystem::exists(folder_.file("out") + "/" + name)) << name;
	EXPECT_EQ(Trajectory::loadTum(folder_.file("out/trajectory.tum")).size(), static_cast<size_t>(result.poses));
	EXPECT_EQ(summary().at("poses"), result.poses);
	EXPECT_TRUE(summary().at("gaps").empty());
	EXPECT_GT(summary().at("minutes").at(0).at("frame_median_ms").get<double>(), 0);
	EXPECT_EQ(summary().at("first_pose").at("v_WB_in_B_m_s").size(), 3u);
}

TEST_F(OdometryRun, SummaryTellsWhatWasCalibratedAndHowWell)
{
	const nlohmann::json given = (runOdometry(options()), summary().at("calibration"));
	EXPECT_EQ(given.at("T_BO").at("state"), "given");
	EXPECT_EQ(given.at("wheel_clock").at("state"), "given");
	EXPECT_GT(given.at("wheels").at("deviation").at("track_m").get<double>(), 0);

	OdometryRunOptions calibrating = options();
	calibrating.odometry.rawlog.wheel_time_offset_s = 0.003;
	calibrating.odometry.estimator.factors.estimate_T_BO = true;
	calibrating.odometry.estimator.factors.estimate_wheel_time_offset = true;
	runOdometry(calibrating);
	const nlohmann::json found = summary().at("calibration");
	EXPECT_EQ(found.at("T_BO").at("state"), "held") << "20 deg are too little of a turn";
	EXPECT_EQ(found.at("T_BO").at("not_observed"), "z of O");
	EXPECT_TRUE(found.at("T_BO").at("deviation").at("p_in_O_m").at(2).is_null());
	EXPECT_EQ(found.at("T_BO").at("q_xyzw"), given.at("T_BO").at("q_xyzw"));
	EXPECT_EQ(found.at("wheel_clock").at("state"), "held");
	EXPECT_EQ(found.at("wheel_clock").at("offset_s"), 0.003);
	EXPECT_EQ(found.at("wheel_clock").at("deviation_s"), 0.02);
	EXPECT_EQ(found.at("camera_clock").at("state"), "given") << "no camera in this mode";
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

/** Every mode writes the pose that was asked for. */
TEST_F(OdometryRun, PoseFramesInModesWithoutTheirSensor)
{
	const std::string rawlog = folder_.file("with_camera.rawlog");
	const CameraModel camera{8, 8, 10, 10, 4, 4, CameraModel::Distortion::none, {}};
	const Pose3 T_OC(forwardOpticalAxes(), Eigen::Vector3d(0.2, 0.05, 0.4)), T_OB(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0.02, 0.3));
	RawlogWriter writer(rawlog);
	int64_t next_ns = 0;
	for (const auto& o : log_.observations())
	{
		writer.write(*o);
		if (nanosecondsOf(o->timestamp) < next_ns) continue;
		next_ns = nanosecondsOf(o->timestamp) + nanoseconds(0.1);
		writer.write(makeEmbeddedImage(nanosecondsOf(o->timestamp), camera, T_OC, mrpt::img::CImage(8, 8, mrpt::img::CH_GRAY)));
	}
	writer.close();
	for (const Mode mode : {Mode::wheel, Mode::wio})
	{
		std::map<PoseFrame, Trajectory> written;
		for (const PoseFrame frame : {PoseFrame::O, PoseFrame::B, PoseFrame::C})
		{
			OdometryRunOptions o = options();
			o.rawlogs = {rawlog};
			o.odometry.estimator.mode = mode;
			o.pose_frame = frame;
			runOdometry(o);
			written[frame] = Trajectory::loadTum(folder_.file("out/trajectory.tum"));
		}
		const Trajectory& O = written[PoseFrame::O];
		ASSERT_GT(O.size(), 30u);
		for (const auto& [frame, T_Ox] : {std::pair{PoseFrame::B, T_OB}, std::pair{PoseFrame::C, T_OC}})
		{
			ASSERT_EQ(written[frame].size(), O.size());
			for (size_t i = 0; i < O.size(); ++i)
			{
				const Pose3 expected = O.poses()[i].T * T_Ox, got = written[frame].poses()[i].T;
				ASSERT_LT((got.p - expected.p).norm(), 1e-6);
				ASSERT_LT(got.R.angularDistance(expected.R), 1e-6);
			}
		}
	}
}

TEST_F(OdometryRun, CoverageIsTimeWithPoses)
{
	const std::string rawlog = folder_.file("gap.rawlog");
	RawlogWriter writer(rawlog);
	const auto observations = log_.observations();
	const int64_t begin_ns = nanosecondsOf(observations.front()->timestamp);
	for (const auto& o : observations)
	{
		if (secondsBetween(begin_ns, nanosecondsOf(o->timestamp)) > 4)
			o->timestamp = mrptTime(nanosecondsOf(o->timestamp) + nanoseconds(40));
		writer.write(*o);
	}
	writer.close();
	OdometryRunOptions o = options();
	o.rawlogs = {rawlog};
	const OdometryRunResult result = runOdometry(o);
	const Trajectory trajectory = Trajectory::loadTum(folder_.file("out/trajectory.tum"));
	double holes_s = 0;
	for (size_t i = 1; i < trajectory.size(); ++i)
		if (const double dt_s = secondsBetween(trajectory.poses()[i - 1].t_ns, trajectory.poses()[i].t_ns); dt_s > 0.5) holes_s += dt_s;
	const double span_s = secondsBetween(trajectory.poses().front().t_ns, trajectory.poses().back().t_ns);
	std::cout << "[measured] coverage " << summary().at("coverage") << ", holes of " << holes_s << " s in " << result.duration_s << " s\n";
	ASSERT_GT(result.duration_s, 40);
	ASSERT_GT(holes_s, 25) << "ten of the forty seconds are filled";
	EXPECT_NEAR(summary().at("coverage").get<double>(), (span_s - holes_s) / result.duration_s, 1e-6);
	EXPECT_EQ(summary().at("imu_gaps"), 1) << "each gap counts once";
	EXPECT_EQ(summary().at("wheel_gaps"), 1);
	EXPECT_EQ(summary().at("gaps").size(), 2u);
}

TEST_F(OdometryRun, NothingUsableIsToldWithItsReason)
{
	const std::string rawlog = folder_.file("nan.rawlog");
	RawlogWriter writer(rawlog);
	for (const auto& o : log_.observations())
	{
		if (const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(o)) imu->set(mrpt::obs::IMU_X_ACC, std::nan(""));
		writer.write(*o);
	}
	writer.close();
	OdometryRunOptions o = options();
	o.rawlogs = {rawlog};
	viwo::testing::expectError([&] { runOdometry(o); }, {"nan.rawlog", "no pose", "IMU: ", "not_finite"});
}

TEST_F(OdometryRun, LogTooShortForAPose)
{
	OdometryRunOptions o = options();
	o.to_s = 0.2;
	viwo::testing::expectError([&] { runOdometry(o); }, {o.rawlogs.front(), "no pose"});
}

TEST_F(OdometryRun, PartWithoutAFrameIsToldWithTheLengthOfTheLog)
{
	OdometryRunOptions o = options();
	o.from_s = 100;
	const auto all = log_.observations();
	char length[32];
	std::snprintf(length, sizeof length, "has %.1f s",
	              secondsBetween(nanosecondsOf(all.front()->timestamp), nanosecondsOf(all.back()->timestamp)));
	viwo::testing::expectError([&] { runOdometry(o); }, {o.rawlogs.front(), "no pose", "--from 100 s is behind the end", length});
	o.from_s = 0.5, o.to_s = 0.501;
	viwo::testing::expectError([&] { runOdometry(o); }, {"no pose", "no frame between --from 0.5 and --to 0.501 s"});
}

TEST_F(OdometryRun, EarlierResultsStayUntilNewOnesAreWhole)
{
	runOdometry(options());
	const std::string before = viwo::testing::readFile(folder_.file("out/trajectory.tum"));
	OdometryRunOptions o = options();
	o.rawlogs = {folder_.file("none.rawlog")};
	viwo::testing::expectError([&] { runOdometry(o); }, {"none.rawlog"});
	EXPECT_EQ(viwo::testing::readFile(folder_.file("out/trajectory.tum")), before);
}
}  // namespace
}  // namespace viwo
