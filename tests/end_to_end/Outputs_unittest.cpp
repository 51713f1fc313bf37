#include <viwo/core/AtomicFile.h>
#include <viwo/core/Time.h>
#include <viwo/evaluation/Consistency.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
/** What a run leaves behind; ten seconds of a log are enough. */
class Outputs : public OdometryProgram
{
   protected:
	void run(const std::string& name, std::vector<std::string> options = {}, const std::string& to_s = "10")
	{
		options.insert(options.end(), {"--to", to_s, "--quiet"});
		odometry(log_.rawlog, name, options);
	}

	const TestLog log_ = testLog(lobbyTestDrive());
};

TEST_F(Outputs, SummaryTellsHowItWent)
{
	run("out");
	const Json s = summary("out");
	for (const char* key :
	     {"mode", "status", "frames", "keyframes", "duration_s", "path_length_m", "first_pose_s", "initialization_time_s", "coverage",
	      "reinitializations", "slip_events", "wall_time_s", "realtime_factor", "peak_rss_mb", "stages_ms", "observations"})
		EXPECT_TRUE(s.contains(key)) << key;
	EXPECT_EQ(s.at("mode"), "viwo");
	EXPECT_NEAR(s.at("duration_s").get<double>(), 10, 0.3);
	EXPECT_NEAR(s.at("frames").get<int>(), 100, 3);
	EXPECT_NEAR(s.at("path_length_m").get<double>(), 0.15 * 9.5, 0.2);
	EXPECT_GT(s.at("peak_rss_mb").get<double>(), 10);
	for (const char* stage : {"decode", "track", "frame"})
		for (const char* key : {"mean", "median", "p95", "max"}) EXPECT_GT(s.at("stages_ms").at(stage).at(key).get<double>(), 0) << stage;
	EXPECT_EQ(s.at("observations").at("IMU").at("class"), "CObservationIMU");
	EXPECT_GT(s.at("observations").at("IMU").at("used").get<int>(), 1900);
	for (const char* label : {"CAM", "IMU", "ODOMETRY"}) EXPECT_TRUE(s.at("observations").at(label).at("rejected").empty());
}

/** Without standard streams the first files that are opened must not take their place. */
TEST_F(Outputs, ClosedStandardStreamsDoNoHarm)
{
	run("out", {"--mode", "wio"}, "5");
	const std::string command = quoted(program("viwo-odometry")) + " -i " + quoted(log_.rawlog) + " -o " + quoted(folder_.file("closed")) +
	                            " --mode wio --to 5 <&- >&- 2>&-";
	EXPECT_EQ(std::system(command.c_str()), 0);
	for (const char* file : {"trajectory.tum", "trajectory_imu_rate.tum", "trajectory_covariance.csv"})
		EXPECT_TRUE(readFile(output("out", file)) == readFile(output("closed", file))) << file;
}

TEST_F(Outputs, TwoRunsInOneFolderDoNotMix)
{
	std::filesystem::create_directories(folder_.file("out"));
	const AtomicFile other(output("out", "trajectory.tum"));
	const ProgramResult second = runOdometry(log_.rawlog, "out", {"--mode", "wheel", "--to", "5", "--quiet"});
	EXPECT_EQ(second.status, 1);
	EXPECT_NE(second.err.find("another program is writing"), std::string::npos) << second.err;
	EXPECT_EQ(second.errorLines(), 1u);
}

TEST_F(Outputs, TrajectoriesAndCovariancesBelongTogether)
{
	run("out");
	const Trajectory frames = trajectory("out"), imu_rate = Trajectory::loadTum(output("out", "trajectory_imu_rate.tum"));
	const auto covariances = loadCovariances(output("out", "trajectory_covariance.csv"));
	ASSERT_EQ(covariances.size(), frames.size());
	EXPECT_LT(frames.poses().front().T.p.norm(), 2e-3) << "W is O at the first pose";
	for (size_t i = 0; i < frames.size(); ++i)
	{
		EXPECT_EQ(covariances[i].t_ns, frames.poses()[i].t_ns);
		EXPECT_TRUE(covariances[i].covariance.allFinite());
		EXPECT_GE(covariances[i].covariance.diagonal().minCoeff(), 0);
	}
	EXPECT_GT(covariances.back().covariance(0, 0), covariances[1].covariance(0, 0)) << "uncertainty grows with the distance";
	EXPECT_NEAR(static_cast<double>(imu_rate.size()), 20.0 * static_cast<double>(frames.size()), 60) << "200 Hz against 10 Hz";
	const std::string csv = readFile(output("out", "trajectory_covariance.csv"));
	EXPECT_EQ(csv.rfind("# frame:", 0), 0u);
	EXPECT_NE(csv.find("\nt_s,x_x,x_y,"), std::string::npos);
	double furthest_m = 0;
	for (const StampedPose& pose : imu_rate.poses())
		if (const auto T = frames.at(pose.t_ns, 0.2)) furthest_m = std::max(furthest_m, (T->p - pose.T.p).norm());
	std::cout << "[measured] IMU-rate poses off the line between frames by up to " << 1000 * furthest_m << " mm\n";
	EXPECT_LT(furthest_m, 0.02);
}

TEST_F(Outputs, LandmarksArePly)
{
	run("out");
	std::ifstream file(output("out", "landmarks.ply"));
	std::string line;
	size_t vertices = 0;
	for (bool header = true; header && std::getline(file, line); header = line != "end_header")
		if (line.rfind("element vertex ", 0) == 0) vertices = std::stoul(line.substr(15));
	EXPECT_GT(vertices, 50u);
	size_t rows = 0, inside = 0;
	while (std::getline(file, line))
	{
		std::istringstream row(line);
		double x = 0, y = 0, z = 0, deviation = 0;
		ASSERT_TRUE(row >> x >> y >> z >> deviation) << line;
		++rows;
		if (std::hypot(x, y) < 13 && z > -0.3 && z < 4) ++inside;
	}
	EXPECT_EQ(rows, vertices);
	std::cout << "[measured] " << inside << " of " << rows << " landmarks are in the lobby\n";
	EXPECT_GT(inside, rows * 9 / 10);
}

TEST_F(Outputs, KeyFramesTellWhereLandmarksWereSeenFrom)
{
	run("out");
	std::map<int64_t, Eigen::Vector3d> cameras;
	std::ifstream frames(output("out", "keyframes.csv"));
	std::string line;
	std::getline(frames, line);
	std::getline(frames, line);
	EXPECT_EQ(line, "t_ns,x,y,z,qx,qy,qz,qw");
	while (std::getline(frames, line))
	{
		long long t_ns = 0;
		double x = 0, y = 0, z = 0;
		ASSERT_EQ(std::sscanf(line.c_str(), "%lld,%lf,%lf,%lf", &t_ns, &x, &y, &z), 4) << line;
		cameras[t_ns] = {x, y, z};
	}
	EXPECT_GT(cameras.size(), 5u);
	// The camera rides 0.3 m above the floor, within the reach of its mounting from where O is.
	const Trajectory odometry = trajectory("out");
	for (const auto& [t_ns, p_WC] : cameras)
	{
		const auto T_WO = odometry.at(t_ns, 0.2);
		if (!T_WO) continue;
		EXPECT_NEAR((p_WC - T_WO->p).norm(), 0.32, 0.1);
	}
	std::ifstream observations(output("out", "landmark_observations.csv"));
	std::getline(observations, line);
	EXPECT_EQ(line, "landmark_id,t_ns");
	size_t count = 0;
	while (std::getline(observations, line))
	{
		unsigned long long id = 0;
		long long t_ns = 0;
		ASSERT_EQ(std::sscanf(line.c_str(), "%llu,%lld", &id, &t_ns), 2) << line;
		EXPECT_EQ(cameras.count(t_ns), 1u) << "each stamp is that of a key frame";
		++count;
	}
	std::cout << "[measured] " << cameras.size() << " key frames, " << count << " sightings of landmarks\n";
	EXPECT_GT(count, 200u);
}

TEST_F(Outputs, PoseFramesDifferByTheirMounting)
{
	for (const char* frame : {"O", "B", "C"}) run(frame, {"--pose-frame", frame}, "4");
	const Trajectory O = trajectory("O"), B = trajectory("B"), C = trajectory("C");
	ASSERT_EQ(O.size(), B.size());
	ASSERT_EQ(O.size(), C.size());
	const Pose3 T_OB(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0.02, 0.3)), T_OC(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0.06, 0.3));
	for (size_t i = 0; i < O.size(); ++i)
	{
		const Pose3 T_WO = O.poses()[i].T, expected_WB = T_WO * T_OB, expected_WC = T_WO * T_OC;
		EXPECT_LT((B.poses()[i].T.p - expected_WB.p).norm(), 1e-6);
		EXPECT_LT(B.poses()[i].T.R.angularDistance(expected_WB.R), 1e-6);
		EXPECT_LT((C.poses()[i].T.p - expected_WC.p).norm(), 0.03) << "T_BC is estimated: centimetres";
		EXPECT_LT(C.poses()[i].T.R.angularDistance(expected_WC.R), 0.03);
	}
	EXPECT_EQ(summary("C").at("pose_frame"), "C");
}

TEST_F(Outputs, SameInputSameBytesAlsoFromTheWrittenConfiguration)
{
	run("first", {}, "8");
	run("second", {}, "8");
	expectSameFiles("first", "second");
	run("from_written", {"-c", output("first", "config.ini")}, "8");
	expectSameFiles("first", "from_written");
	run("from_shipped", {"-c", VIWO_SOURCE_DIR "/share/viwo/config_files/viwo-odometry/default.ini"}, "8");
	expectSameFiles("first", "from_shipped");
}

TEST_F(Outputs, PartOfTheLog)
{
	odometry(log_.rawlog, "part", {"--from", "5", "--to", "9", "--mode", "wheel", "--quiet"});
	const int64_t begin_ns = Trajectory::loadTum(log_.ground_truth).poses().front().t_ns;
	const Trajectory part = trajectory("part");
	EXPECT_NEAR(secondsBetween(begin_ns, part.poses().front().t_ns), 5, 0.3);
	EXPECT_NEAR(secondsBetween(begin_ns, part.poses().back().t_ns), 9, 0.3);
	EXPECT_NEAR(summary("part").at("duration_s").get<double>(), 4, 0.4);
}

TEST_F(Outputs, RealtimeReplayKeepsTheClockOfTheLog)
{
	odometry(log_.rawlog, "slow", {"--mode", "wheel", "--to", "2", "--realtime", "--quiet"});
	odometry(log_.rawlog, "fast", {"--mode", "wheel", "--to", "2", "--quiet"});
	EXPECT_GE(summary("slow").at("wall_time_s").get<double>(), 1.9);
	EXPECT_LT(summary("fast").at("wall_time_s").get<double>(), 1.5);
	EXPECT_TRUE(readFile(output("slow", "trajectory.tum")) == readFile(output("fast", "trajectory.tum")));
}

TEST_F(Outputs, ModeWithoutImuGivesNoImuRate)
{
	run("wheel", {"--mode", "wheel"}, "5");
	EXPECT_EQ(summary("wheel").at("mode"), "wheel");
	const Trajectory frames = trajectory("wheel");
	EXPECT_GT(frames.size(), 30u);
}
}  // namespace
}  // namespace viwo::testing
