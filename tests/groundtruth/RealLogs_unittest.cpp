#include "RunProgram.h"

#include <viwo/core/Trajectory.h>
#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

using namespace viwo;
using namespace viwo::testing;

/** The defaults on logs of real robots (where VIWO_TEST_DATA is set) and on those that come with MRPT. */
namespace
{
std::string tool(const std::string& name)
{
	return VIWO_BINARY_DIR "/bin/" + name;
}

/** Relation errors of a CARMEN log: imported, solved, evaluated by the three programs. */
Json relationsOf(const std::string& name, const std::vector<std::string>& sensor, Json& summary)
{
	const std::string data = std::string(std::getenv("VIWO_TEST_DATA")) + "/slam_benchmark/" + name;
	const TempFolder folder;
	const std::string rawlog = folder.file(name + ".rawlog"), out = folder.file("out");
	const ProgramResult imported = runProgram(tool("viwo-import"), {"carmen", data + ".clf.bz2", "-o", rawlog, "--quiet"});
	EXPECT_EQ(imported.status, 0) << imported.err;
	const ProgramResult solved = runProgram(tool("viwo-groundtruth"), {"-i", rawlog, "-o", out, "--quiet"});
	EXPECT_EQ(solved.status, 0) << solved.err;
	std::vector<std::string> arguments{"relations",
	                                   "-r",
	                                   data + ".relations",
	                                   "-e",
	                                   out + "/trajectory.tum",
	                                   "--stamps",
	                                   folder.file(name + "_stamps.csv"),
	                                   "--json",
	                                   folder.file("errors.json")};
	arguments.insert(arguments.end(), sensor.begin(), sensor.end());
	const ProgramResult evaluated = runProgram(tool("viwo-evaluate"), arguments);
	EXPECT_EQ(evaluated.status, 0) << evaluated.err;
	if (evaluated.status != 0) return {};
	summary = loadJson(out + "/summary.json");
	std::cout << "[measured] " << name << "\n"
	          << evaluated.out << "[measured] CPU " << summary["cpu_time_s"] << " s, memory " << summary["peak_memory_mb"] << " MB\n";
	return loadJson(folder.file("errors.json"));
}

std::string mrptDatasets()
{
	const char* folder = std::getenv("VIWO_MRPT_DATASETS");
	return folder == nullptr ? "/usr/share/mrpt/datasets" : folder;
}

/** Row i of the ground truth (t x y yaw) is that of scan i: its own stamps are not those of the scans. */
double ate_m(const Trajectory& estimate, const std::string& ground_truth)
{
	std::ifstream file(ground_truth);
	Trajectory truth;
	double t = 0, x = 0, y = 0, yaw = 0;
	while (truth.size() < estimate.size() && file >> t >> x >> y >> yaw)
		truth.push_back({estimate.poses()[truth.size()].t_ns,
		                 Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(x, y, 0))});
	EXPECT_EQ(truth.size(), estimate.size());
	EvaluationOptions options;
	options.alignment = AlignmentKind::yaw;
	return evaluate(truth, estimate, options).ate_xy_m;
}
}  // namespace

TEST(RealLogs, Intel)
{
	if (std::getenv("VIWO_TEST_DATA") == nullptr) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	Json summary;
	const Json e = relationsOf("intel", {}, summary);
	ASSERT_FALSE(e.is_null());
	EXPECT_EQ(e["evaluated"], 2984);
	EXPECT_EQ(summary["scans"], 13631);
	EXPECT_LE(e["trans_mean_m"], 0.0225);
	EXPECT_LE(e["trans_max_m"], 0.15);
	EXPECT_LE(e["rot_mean_deg"], 0.75);
	EXPECT_LE(summary["cpu_time_s"], 90);
	EXPECT_LE(summary["peak_memory_mb"], 1000);
}

TEST(RealLogs, Freiburg079)
{
	if (std::getenv("VIWO_TEST_DATA") == nullptr) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	Json summary;
	const Json e = relationsOf("fr079", {"--sensor", "-0.04", "0", "0"}, summary);
	ASSERT_FALSE(e.is_null());
	EXPECT_EQ(e["evaluated"], 1685);
	EXPECT_LE(e["trans_mean_m"], 0.045);
	EXPECT_GT(e["sensor"]["trans_mean_m"], 0.0);
}

/** 525 m outdoors at 4 m/s: after that way, tracking alone is 13 m off, and the place is seen again from the other lane. */
TEST(RealLogs, UalLoopIsClosedByVote)
{
	const char* data = std::getenv("VIWO_TEST_DATA");
	if (data == nullptr) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	const TempFolder folder;
	const ProgramResult solved =
	    runProgram(tool("viwo-groundtruth"),
	               {"-i", std::string(data) + "/ual/ual_dataset_2014_05_23_2dlaser_odo.rawlog", "-o", folder.file("out"), "--quiet"});
	ASSERT_EQ(solved.status, 0) << solved.err;
	const Json summary = loadJson(folder.file("out/summary.json"));
	const Trajectory trajectory = Trajectory::loadTum(folder.file("out/trajectory.tum"));
	double longest_m = 0;
	for (size_t i = 1; i < trajectory.size(); ++i)
		longest_m = std::max(longest_m, (trajectory.poses()[i].T.p - trajectory.poses()[i - 1].T.p).norm());
	const Eigen::Vector3d end = trajectory.poses().back().T.p;
	std::cout << "[measured] " << summary["loops"] << ", end at " << end.x() << " " << end.y() << " m, longest step " << longest_m
	          << " m\n";
	EXPECT_GE(summary["loops"]["accepted"], 10);
	// The last place is on the lane that was driven first.
	double nearest_m = 1e9;
	for (size_t i = 0; i < trajectory.size() / 4; ++i) nearest_m = std::min(nearest_m, (trajectory.poses()[i].T.p - end).norm());
	EXPECT_LT(nearest_m, 3);
	EXPECT_LT(longest_m, 3) << "4 m/s, and holes of half a second: the correction must not go into one step";
}

TEST(RealLogs, SimulatedByMrptWithExactTruth)
{
	const std::string folder = mrptDatasets() + "/graphslam-engine-demos/action_observations_map/";
	if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: install mrpt-common, or set VIWO_MRPT_DATASETS";
	for (const auto& [name, bar_m] : {std::pair<std::string, double>{"simul", 0.04}, {"range_030_bearing_015", 0.12}})
	{
		const TempFolder out;
		const ProgramResult solved =
		    runProgram(tool("viwo-groundtruth"), {"-i", folder + name + ".rawlog", "-o", out.file("out"), "--quiet"});
		ASSERT_EQ(solved.status, 0) << solved.err;
		const double e = ate_m(Trajectory::loadTum(out.file("out/trajectory.tum")), folder + name + ".rawlog.GT.txt");
		std::cout << "[measured] " << name << ": ATE " << e << " m\n";
		EXPECT_LE(e, bar_m) << name;
	}
}
