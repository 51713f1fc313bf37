#include <cstdio>

#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
const std::string kRawlogs = VIWO_SOURCE_DIR "/rawlogs";

class Sample : public OdometryProgram
{
};

TEST_F(Sample, ShippedConfigurationOnShippedRawlog)
{
	const std::string config = VIWO_SOURCE_DIR "/share/viwo/config_files/viwo-odometry/default.ini";
	odometry(kRawlogs + "/sample.rawlog", "viwo", {"-c", config, "--quiet"});
	odometry(kRawlogs + "/sample.rawlog", "wheel", {"-c", config, "--mode", "wheel", "--quiet"});
	const TrajectoryErrors viwo = errors("viwo", kRawlogs + "/sample_ground_truth.tum"),
	                       wheel = errors("wheel", kRawlogs + "/sample_ground_truth.tum");
	std::printf("[measured] sample: viwo %.2f cm, wheel %.2f cm of %.2f m, coverage %.3f\n", 100 * viwo.ate_xyz_m, 100 * wheel.ate_xyz_m,
	            viwo.length_m, viwo.coverage);
	EXPECT_LT(viwo.ate_xyz_m, 0.02);
	EXPECT_LT(viwo.ate_xyz_m, 0.6 * wheel.ate_xyz_m);
	EXPECT_GE(viwo.coverage, 0.96);
	EXPECT_TRUE(summary("viwo").at("observations").contains("LMS100"));
}

/** MRPT's own tool cuts a rawlog without making an image folder for the piece. */
TEST_F(Sample, PieceCutByRawlogEdit)
{
	if (runProgram("sh", {"-c", "command -v rawlog-edit"}).status != 0) GTEST_SKIP() << "no rawlog-edit here (Debian package mrpt-apps)";
	for (const char* name : {"sample.rawlog", "sample_Images"}) std::filesystem::create_symlink(kRawlogs + "/" + name, folder_.file(name));
	const int64_t begin_ns = Trajectory::loadTum(kRawlogs + "/sample_ground_truth.tum").poses().front().t_ns;
	const std::string from = std::to_string(begin_ns / 1000000000 + 3), to = std::to_string(begin_ns / 1000000000 + 10);
	const ProgramResult cut = runProgram("sh", {"-c", "cd " + folder_.path() + " && rawlog-edit -i sample.rawlog --cut --from-time " +
	                                                      from + " --to-time " + to + " -o cut.rawlog"});
	ASSERT_EQ(cut.status, 0) << cut.err;
	odometry(folder_.file("cut.rawlog"), "cut", {"--quiet"});
	const TrajectoryErrors e = errors("cut", kRawlogs + "/sample_ground_truth.tum");
	std::printf("[measured] piece of the sample: %.2f cm of %.2f m\n", 100 * e.ate_xyz_m, e.length_m);
	EXPECT_LT(e.ate_xyz_m, 0.03);
	EXPECT_NEAR(summary("cut").at("duration_s").get<double>(), 7, 0.4);
}
}  // namespace
}  // namespace viwo::testing
