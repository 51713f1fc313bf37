#include "RunProgram.h"
#include "SmallRecordings.h"

#include <gtest/gtest.h>
#include <viwo/importers/RosBagImporter.h>

#include <filesystem>

using namespace viwo;
using namespace viwo::testing;

namespace
{
ProgramResult run(const std::vector<std::string>& arguments)
{
	return runProgram(VIWO_BINARY_DIR "/bin/viwo-import", arguments);
}
}  // namespace

TEST(ImportProgram, Euroc)
{
	const TempFolder folder;
	writeEuroc(folder);
	const ProgramResult result = run({"euroc", folder.path(), "-o", folder.file("x.rawlog")});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(result.out.find("21 images, 201 IMU samples, 41 odometry samples"), std::string::npos) << result.out;
	EXPECT_TRUE(std::filesystem::exists(folder.file("x.rawlog")));
	EXPECT_TRUE(std::filesystem::exists(folder.file("x_ground_truth.tum")));
	EXPECT_NE(result.err.find("note: "), std::string::npos);
	EXPECT_EQ(run({"euroc", folder.path(), "-o", folder.file("x.rawlog"), "--quiet"}).err, "");
}

TEST(ImportProgram, Kitti)
{
	const TempFolder folder;
	writeKitti(folder);
	write(folder, "x_gps.tum", "of another recording");
	const ProgramResult result =
	    run({"kitti", folder.path(), "-o", folder.file("x.rawlog"), "--speed-noise", "0.05", "--speed-scale", "1.01", "--seed", "4"});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(result.out.find("20 images, 100 IMU samples, 100 odometry samples"), std::string::npos) << result.out;
	EXPECT_NE(result.err.find("x_gps.tum: was there before"), std::string::npos) << result.err;
	EXPECT_TRUE(std::filesystem::exists(folder.file("x_gps.tum.old")));
	EXPECT_FALSE(std::filesystem::exists(folder.file("x_gps.tum")));
	EXPECT_TRUE(std::filesystem::exists(folder.file("x_ground_truth.tum")));
}

TEST(ImportProgram, RosBagThatIsNone)
{
	const TempFolder folder;
	const std::string path = write(folder, "x.bag", "no bag");
	const ProgramResult result = run({"rosbag", path, "-o", folder.file("x.rawlog"), "--auto"});
	EXPECT_EQ(result.status, 1);
	EXPECT_EQ(result.errorLines(), 1u) << result.err;
	EXPECT_NE(result.err.find(hasRosBagSupport() ? "not a ROS bag" : "built without ROS bags"), std::string::npos) << result.err;
	EXPECT_EQ(run({"rosbag", path, "-o", folder.file("x.rawlog"), "--auto", "--map", path}).status, 2);
}

TEST(ImportProgram, ErrorsAndUsage)
{
	const TempFolder folder;
	const ProgramResult failed = run({"euroc", folder.path(), "-o", folder.file("x.rawlog")});
	EXPECT_EQ(failed.status, 1);
	EXPECT_EQ(failed.errorLines(), 1u) << failed.err;
	for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
	                                                  {"euroc", folder.path()},
	                                                  {"mcap", folder.path(), "-o", "x"},
	                                                  {"kitti", folder.path(), "-o", "x", "--speed-scale", "-1"}})
	{
		const ProgramResult bad = run(arguments);
		EXPECT_EQ(bad.status, 2) << bad.err;
		EXPECT_EQ(bad.errorLines(), 1u) << bad.err;
	}
	writeEuroc(folder);
	EXPECT_EQ(run({"euroc", folder.path(), "-o", folder.file("no/such/folder/x.rawlog")}).status, 1);
}

TEST(ImportProgram, Help)
{
	const ProgramResult help = run({"--help"});
	EXPECT_EQ(help.status, 0);
	EXPECT_NE(help.out.find("Examples:"), std::string::npos);
	EXPECT_EQ(run({"kitti", "--help"}).status, 0);
	EXPECT_EQ(run({"--version"}).out.rfind("viwo-import (viwo) ", 0), 0u);
}
