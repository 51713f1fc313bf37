#include <gtest/gtest.h>

#include <filesystem>

#include "RunProgram.h"
#include "TempFolder.h"

namespace viwo::sim
{
namespace
{
const std::string kProgram = std::string(VIWO_BINARY_DIR) + "/bin/viwo-sim";

class ViwoSimProgram : public ::testing::Test
{
   protected:
	void SetUp() override
	{
		if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << kProgram << " is not built (VIWO_BUILD_APPS is off)";
	}

	const viwo::testing::TempFolder folder_;
};

TEST_F(ViwoSimProgram, HelpShowsExamples)
{
	const auto result = viwo::testing::runProgram(kProgram, {"--help"});
	EXPECT_EQ(result.status, 0);
	EXPECT_NE(result.out.find("Examples:"), std::string::npos);
	EXPECT_NE(result.out.find("--no-images"), std::string::npos);
}

TEST_F(ViwoSimProgram, ShippedFilesServeByName)
{
	const std::string output = folder_.file("x.rawlog");
	const auto result = viwo::testing::runProgram(
	    kProgram, {"--world", "lobby", "--route", "sample", "--set", "route.duration_s=2", "--seed", "4", "--no-images", "-o", output});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_EQ(result.err, "");
	for (const char* name : {"x.rawlog", "x_ground_truth.tum", "x_simulation.ini"})
		EXPECT_TRUE(std::filesystem::exists(folder_.file(name)));
	const std::string again = folder_.file("y.rawlog"), configuration = folder_.file("x_simulation.ini");
	const auto repeated = viwo::testing::runProgram(
	    kProgram, {"--world", "lobby", "--route", configuration, "--rig", configuration, "--seed", "4", "--no-images", "-o", again});
	EXPECT_EQ(repeated.status, 0) << repeated.err;
	EXPECT_TRUE(viwo::testing::readFile(output) == viwo::testing::readFile(again)) << "the written options make the same log";
}

TEST_F(ViwoSimProgram, ASequenceIsItsWorldRouteAndRig)
{
	const std::vector<std::string> common{"--set", "route.duration_s=2", "--no-images", "-o"};
	const auto simulate = [&](std::vector<std::string> arguments, const std::string& output)
	{
		arguments.insert(arguments.end(), common.begin(), common.end());
		arguments.push_back(folder_.file(output));
		return viwo::testing::runProgram(kProgram, arguments);
	};
	ASSERT_EQ(simulate({"--sequence", "seq05", "--seed", "2"}, "a.rawlog").status, 0);
	ASSERT_EQ(simulate({"--world", "lobby", "--route", "seq05", "--rig", "turtlebot2_slipping", "--seed", "2"}, "b.rawlog").status, 0);
	EXPECT_TRUE(viwo::testing::readFile(folder_.file("a.rawlog")) == viwo::testing::readFile(folder_.file("b.rawlog")));
	EXPECT_EQ(simulate({"--sequence", "seq05", "--route", "sample"}, "c.rawlog").status, 2) << "two routes";
	EXPECT_EQ(simulate({"--sequence", "seq77"}, "c.rawlog").status, 1);
}

TEST_F(ViwoSimProgram, ImagesOfARunThatDiffersInItsWheelsAlone)
{
	const std::vector<std::string> common{"--world", "lobby", "--route", "sample", "--set", "route.duration_s=0.5"};
	const auto simulate = [&](const std::string& name, std::vector<std::string> more)
	{
		more.insert(more.begin(), common.begin(), common.end());
		more.insert(more.end(), {"-o", folder_.file(name)});
		const auto result = viwo::testing::runProgram(kProgram, more);
		ASSERT_EQ(result.status, 0) << result.err;
	};
	const std::string taken = "--images-from", from = folder_.file("a_Images"), set = "--set", slip = "wheels.radius_error=0.02";
	simulate("a.rawlog", {});
	simulate("taken.rawlog", {taken, from, set, slip});
	simulate("rendered.rawlog", {set, slip});
	size_t images = 0;
	for (const auto& entry : std::filesystem::directory_iterator(folder_.file("rendered_Images")))
	{
		const std::string name = entry.path().filename().string();
		EXPECT_TRUE(viwo::testing::readFile(entry.path().string()) == viwo::testing::readFile(folder_.file("taken_Images/" + name)))
		    << name;
		++images;
	}
	EXPECT_EQ(images, 5u);
	EXPECT_TRUE(viwo::testing::readFile(folder_.file("taken.rawlog")) == viwo::testing::readFile(folder_.file("rendered.rawlog")));
	std::filesystem::remove_all(folder_.file("a_Images"));
	std::filesystem::create_directory(folder_.file("a_Images"));
	const auto none = viwo::testing::runProgram(kProgram, {"--route", "sample", taken, from, "-o", folder_.file("b.rawlog")});
	EXPECT_EQ(none.status, 1);
	EXPECT_EQ(none.errorLines(), 1u) << none.err;
}

TEST_F(ViwoSimProgram, MistakesAreOneLineAndAnExitStatus)
{
	const std::string output = folder_.file("x.rawlog");
	const auto failsWith = [&](int status, const std::vector<std::string>& arguments, const std::string& part)
	{
		const auto result = viwo::testing::runProgram(kProgram, arguments);
		EXPECT_EQ(result.status, status) << result.err;
		EXPECT_EQ(result.errorLines(), 1u) << result.err;
		EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
		EXPECT_FALSE(std::filesystem::exists(output));
	};
	failsWith(2, {"--no-images"}, "--output");
	failsWith(1, {"--no-images", "-o", output, "--world", "moon"}, "moon");
	failsWith(1, {"--no-images", "-o", output, "--rig", folder_.file("no.ini")}, "no.ini");
	failsWith(1, {"--no-images", "-o", output, "--set", "imu.rate_hz=often"}, "rate_hz");
	failsWith(1, {"--no-images", "-o", output, "--set", "route.segments=fly 3 m"}, "fly 3 m");
	failsWith(1, {"--no-images", "-o", folder_.file("no/folder/x.rawlog"), "--set", "route.segments=stand 1 s"}, "no/folder");
}
}  // namespace
}  // namespace viwo::sim
