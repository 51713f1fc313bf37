#include <gtest/gtest.h>
#include <viwo/evaluation/Json.h>

#include <csignal>

#include "FakePrograms.h"
#include "RunProgram.h"

namespace viwo::experiments
{
namespace
{
const std::string kProgram = VIWO_BINARY_DIR "/bin/viwo-experiments";

class ExperimentsProgram : public ::testing::Test
{
   protected:
	std::vector<std::string> arguments(const std::vector<std::string>& more) const
	{
		std::vector<std::string> all{"--programs", programs_.folder(), "-o", out_.path()};
		all.insert(all.end(), more.begin(), more.end());
		return all;
	}

	viwo::testing::FakePrograms programs_;
	viwo::testing::TempFolder out_;
};

TEST_F(ExperimentsProgram, BadUsageIsOneLine)
{
	for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{{"--jobs", "0"},
	                                                                                   {"--seeds", "3-1"},
	                                                                                   {"--seeds", ""},
	                                                                                   {"--sequences", "seq07"},
	                                                                                   {"--sequences", ""},
	                                                                                   {"--tables", "4"},
	                                                                                   {"--tables", "none"},
	                                                                                   {"--error-budget", ""},
	                                                                                   {"--cache", ""}})
	{
		const viwo::testing::ProgramResult result = viwo::testing::runProgram(kProgram, arguments(wrong));
		EXPECT_EQ(result.status, 2) << wrong[0] << " " << wrong[1];
		EXPECT_EQ(result.errorLines(), 1u) << result.err;
	}
	EXPECT_EQ(programs_.count(""), 0) << "nothing was run";
}

TEST_F(ExperimentsProgram, FoldersThatCannotBeMadeAreTold)
{
	const std::string file = out_.file("file");
	viwo::testing::writeFile(file, "x");
	for (const std::vector<std::string>& words :
	     {std::vector<std::string>{"-o", file}, {"-o", "/proc/x"}, {"-o", out_.path(), "--cache", file}})
	{
		std::vector<std::string> all{"--programs", programs_.folder(), "--sequences", "seq05", "--seeds", "1", "--tables", "1"};
		all.insert(all.end(), words.begin(), words.end());
		const viwo::testing::ProgramResult result = viwo::testing::runProgram(kProgram, all);
		EXPECT_EQ(result.status, 1);
		EXPECT_EQ(result.errorLines(), 1u) << result.err;
		EXPECT_NE(result.err.find("cannot create this folder"), std::string::npos) << result.err;
	}
}

TEST_F(ExperimentsProgram, ASignalLeavesTablesAndTheSameCommandGoesOn)
{
	programs_.takeTime();
	const std::vector<std::string> words = arguments({"--sequences", "seq05,seq06", "--seeds", "1", "--tables", "1", "-j", "1"});
	const viwo::testing::ProgramResult first =
	    viwo::testing::runAndSignal(kProgram, words, SIGTERM, out_.file("runs/seq06-s1-vio/inputs.txt"), 0.05);
	EXPECT_EQ(first.status, 1);
	EXPECT_NE(first.err.find("programs have not run"), std::string::npos) << first.err;
	EXPECT_NE(first.out.find("seq05     ours"), std::string::npos) << first.out;
	EXPECT_FALSE(loadJson(out_.file("table1.json")).at("complete").get<bool>());
	EXPECT_TRUE(std::filesystem::exists(out_.file("report.html")));
	const viwo::testing::ProgramResult second = viwo::testing::runProgram(kProgram, words);
	EXPECT_EQ(second.status, 0) << second.err;
	EXPECT_EQ(second.err.find("seq05"), std::string::npos) << "what was done is not done again\n" << second.err;
	EXPECT_NE(second.err.find("[8/8]"), std::string::npos) << second.err;
	EXPECT_TRUE(loadJson(out_.file("table1.json")).at("complete").get<bool>());
}
}  // namespace
}  // namespace viwo::experiments
