#include "RunProgram.h"
#include "TempFolder.h"

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <viwo/core/Trajectory.h>
#include <viwo/mapping/OctoMapRun.h>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace viwo
{
namespace
{
using namespace testing;
namespace fs = std::filesystem;

const std::string kDatasets = "/usr/share/mrpt/datasets/";

/** Of a rawlog that holds one observation, with the vehicle at the origin. */
OctoMapRunOptions singleObservation(const TempFolder& folder, const std::string& name, const std::string& t_s)
{
	OctoMapRunOptions options;
	options.rawlog = kDatasets + name;
	options.trajectory = folder.file("pose.tum");
	options.output = folder.file("map.ot");
	options.threads = 2;
	writeFile(options.trajectory, t_s + " 0 0 0 0 0 0 1\n");
	return options;
}

double cpuOfChildren_s()
{
	rusage usage{};
	getrusage(RUSAGE_CHILDREN, &usage);
	const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
	return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double numberAfter(const std::string& text, const std::string& key)
{
	return std::atof(text.substr(text.find(key) + key.size()).c_str());
}
}  // namespace

TEST(RealRawlogs, DepthImageOfMrptCommon)
{
	if (!fs::exists(kDatasets + "tests_rgbd.rawlog")) GTEST_SKIP() << "the package mrpt-common is not installed";
	const TempFolder folder;
	OctoMapRunOptions options = singleObservation(folder, "tests_rgbd.rawlog", "1462879443.617188500");
	options.resolution_m = 0.03;
	options.colours = VoxelColours::sensor;
	const OctoMapRunResult result = runOctoMap(options);
	std::cout << "[measured] " << result.rays << " rays, " << result.occupied << " occupied and " << result.free << " free leaves, "
	          << result.wall_time_s << " s\n";
	EXPECT_EQ(result.rays, 273225u);
	std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(options.output));
	const auto& tree = dynamic_cast<const octomap::ColorOcTree&>(*read);
	size_t coloured = 0, occupied = 0;
	for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
	{
		if (!tree.isNodeOccupied(*leaf)) continue;
		++occupied;
		coloured += leaf->isColorSet();
		EXPECT_GT(leaf.getX(), 0) << "a camera that looks along x";
		EXPECT_LT(leaf.getX(), 5.1) << "its maximum range";
	}
	EXPECT_GT(coloured, occupied * 8 / 10);
}

TEST(RealRawlogs, VelodyneOfMrptCommon)
{
	if (!fs::exists(kDatasets + "test_velodyne_VLP16.rawlog")) GTEST_SKIP() << "the package mrpt-common is not installed";
	const TempFolder folder;
	OctoMapRunOptions options = singleObservation(folder, "test_velodyne_VLP16.rawlog", "1519637061.085268000");
	options.resolution_m = 0.2;
	options.casting.max_range_m = 40;
	const OctoMapRunResult result = runOctoMap(options);
	std::cout << "[measured] " << result.rays << " rays, " << result.occupied << " occupied and " << result.free << " free leaves, "
	          << result.wall_time_s << " s\n";
	EXPECT_GT(result.rays, 10000u);
	EXPECT_GT(result.occupied, 3000u);
	EXPECT_GT(result.free, 10 * result.occupied);
}

/** The Intel Research Lab log: imported, its trajectory from its scans, mapped at 0.05 m. */
TEST(RealRawlogs, IntelLog)
{
	const char* data = std::getenv("VIWO_TEST_DATA");
	if (!data) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	const TempFolder folder;
	const std::string bin = VIWO_BINARY_DIR "/bin/", rawlog = folder.file("intel.rawlog"), truth = folder.file("truth");
	ProgramResult run =
	    runProgram(bin + "viwo-import", {"carmen", std::string(data) + "/slam_benchmark/intel.clf.bz2", "-o", rawlog, "--quiet"});
	ASSERT_EQ(run.status, 0) << run.err;
	run = runProgram(bin + "viwo-groundtruth", {"-i", rawlog, "-o", truth, "--threads", "2", "--quiet"});
	ASSERT_EQ(run.status, 0) << run.err;
	const double before_s = cpuOfChildren_s();
	run =
	    runProgram(bin + "viwo-octomap", {"-i", rawlog, "-t", truth + "/trajectory.tum", "-o", folder.file("intel.bt"), "--flags",
	                                      truth + "/trajectory_covariance.csv", "--threads", "2", "--to-grid", folder.file("intel.yaml")});
	ASSERT_EQ(run.status, 0) << run.err;
	// The bound is on the time of a machine that does nothing else: that of all threads together is an upper bound of it under any load.
	const double cpu_s = cpuOfChildren_s() - before_s, memory_mb = numberAfter(run.out, " s, ");
	std::cout << "[measured] " << cpu_s << " s of CPU; " << run.out << run.err;
	const double observations = numberAfter(run.out, "intel.bt: ");
	EXPECT_GE(observations, 13000);
	EXPECT_LE(cpu_s, 30);
	EXPECT_LE(memory_mb, 200);
	EXPECT_GT(memory_mb, 0);
	EXPECT_GT(fs::file_size(folder.file("intel.pgm")), 100000u) << "its laser is at z = 0";
}
}  // namespace viwo
