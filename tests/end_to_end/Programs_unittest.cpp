#include "Programs.h"
#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
TEST(Programs, HelpShowsExamplesAndExitStatus)
{
	ASSERT_GE(allPrograms().size(), 4u);
	for (const std::string& name : allPrograms())
	{
		const ProgramResult result = runProgram(program(name), {"--help"});
		EXPECT_EQ(result.status, 0) << name << ": " << result.err;
		EXPECT_EQ(result.err, "");
		for (const char* part : {"Usage:", "--version", "Examples:", "Exit status:"})
			EXPECT_NE(result.out.find(part), std::string::npos) << name << " --help lacks " << part;
	}
}

TEST(Programs, Version)
{
	for (const std::string& name : allPrograms())
	{
		const ProgramResult result = runProgram(program(name), {"--version"});
		EXPECT_EQ(result.status, 0) << name;
		EXPECT_EQ(result.out.rfind(name + " (viwo) ", 0), 0u) << result.out;
	}
}

TEST(Programs, BadUsageIsOneLineAndStatusTwo)
{
	for (const std::string& name : allPrograms())
		for (const std::vector<std::string>& arguments : {std::vector<std::string>{}, std::vector<std::string>{"--no-such-option"}})
		{
			const ProgramResult result = runProgram(program(name), arguments);
			EXPECT_EQ(result.status, 2) << name;
			EXPECT_EQ(result.errorLines(), 1u) << result.err;
			EXPECT_EQ(result.err.rfind(name + ": error: ", 0), 0u) << result.err;
		}
	const ProgramResult mode = runProgram(program("viwo-odometry"), {"-i", "x.rawlog", "-o", "out", "--mode", "lidar"});
	EXPECT_EQ(mode.status, 2);
	EXPECT_EQ(mode.errorLines(), 1u) << mode.err;
	const std::vector<std::vector<std::string>> bad{
	    {"--from", "nan"}, {"--to", "nan"}, {"--from", "inf"}, {"--speed", "2"}, {"--realtime", "--speed", "0"}};
	for (std::vector<std::string> arguments : bad)
	{
		const std::string option = arguments[arguments.size() - 2];
		arguments.insert(arguments.begin(), {"-i", "x.rawlog", "-o", "out"});
		const ProgramResult result = runProgram(program("viwo-odometry"), arguments);
		EXPECT_EQ(result.status, 2) << option << ": " << result.err;
		EXPECT_EQ(result.errorLines(), 1u) << result.err;
		EXPECT_LT(result.err.size(), 160u) << result.err;
		EXPECT_NE(result.err.find(option), std::string::npos) << result.err;
	}
	for (const std::vector<std::string>& arguments :
	     {std::vector<std::string>{"-i", "", "-o", "out"}, std::vector<std::string>{"-i", "x.rawlog", "-o", ""}})
	{
		const ProgramResult result = runProgram(program("viwo-odometry"), arguments);
		EXPECT_EQ(result.status, 2) << result.err;
		EXPECT_NE(result.err.find("empty"), std::string::npos) << result.err;
	}
	EXPECT_EQ(runProgram(program("viwo-evaluate"), {"-r", "a.tum", "-e", "b.tum", "--max-ate", "nan"}).status, 2);
	const ProgramResult span = runProgram(program("viwo-odometry"), {"-i", "x.rawlog", "-o", "out", "--from", "5", "--to", "4"});
	EXPECT_EQ(span.status, 2);
	EXPECT_NE(span.err.find("--to"), std::string::npos) << span.err;
}
}  // namespace
}  // namespace viwo::testing
