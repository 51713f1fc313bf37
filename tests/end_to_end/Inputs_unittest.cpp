#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/rawlog/RawlogWriter.h>

#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
class Inputs : public OdometryProgram
{
   protected:
	/** The log without images, which its modes without a camera do not need, cut in two at that time. */
	std::vector<std::string> halves(double cut_s)
	{
		const std::vector<std::string> paths{folder_.file("first.rawlog"), folder_.file("second.rawlog")};
		RawlogWriter first(paths[0]), second(paths[1]);
		RawlogReader reader(log_.rawlog);
		std::optional<int64_t> begin_ns;
		while (const auto o = reader.next())
		{
			const int64_t t_ns = nanosecondsOf(o->timestamp);
			if (!begin_ns) begin_ns = t_ns;
			(secondsBetween(*begin_ns, t_ns) < cut_s ? first : second).write(*o);
		}
		first.close();
		second.close();
		return paths;
	}

	const TestLog log_ = testLog(lobbyTestDrive());
};

TEST_F(Inputs, TwoHalvesAreOneRun)
{
	odometry(log_.rawlog, "whole", {"--mode", "wio"});
	const auto parts = halves(9.5);
	odometry(parts[0], "parts", {"-i", parts[1], "--mode", "wio"});
	expectSameFiles("whole", "parts");
	EXPECT_EQ(summary("parts").at("rawlog").size(), 2u);
	const ProgramResult swapped = runOdometry(parts[1], "swapped", {"-i", parts[0], "--mode", "wio"});
	EXPECT_EQ(swapped.status, 1);
	EXPECT_NE(swapped.err.find("in the order of their time"), std::string::npos) << swapped.err;
	EXPECT_FALSE(std::filesystem::exists(output("swapped", "trajectory.tum"))) << "told before anything is computed";
}

TEST_F(Inputs, StandardInputIsALogLikeAnyOther)
{
	odometry(log_.rawlog, "file", {"--mode", "viwo", "--to", "6"});
	const std::string pipe = "cd " + quoted(std::filesystem::path(log_.rawlog).parent_path().string()) + " && cat " + quoted(log_.rawlog) +
	                         " | " + quoted(program("viwo-odometry")) + " -i - --to 6 --quiet -o " + quoted(folder_.file("piped"));
	const ProgramResult result = runProgram("/bin/sh", {"-c", pipe});
	ASSERT_EQ(result.status, 0) << result.err;
	expectSameFiles("file", "piped");
}
}  // namespace
}  // namespace viwo::testing
