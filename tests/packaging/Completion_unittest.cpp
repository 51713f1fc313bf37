#include <gtest/gtest.h>

#include "Shell.h"

namespace viwo::testing
{
namespace
{
using Words = std::vector<std::string>;

/** What bash offers for the last of the words, in a folder with some files. */
class Completion : public ::testing::Test
{
   protected:
	Completion()
	{
		for (const char* name : {"a.rawlog", "b.rawlog", "my robot.ini", "b.bag", "run.bt", "run.ot", "runs/c.rawlog", "notes.txt"})
			write(folder_, name, "x");
	}

	Words offered(const Words& words) const
	{
		const std::string script =
		    "set -u; source \"$1\"; cd \"$2\"; shift 2; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); name=${1##*/}; "
		    "[ \"$(complete -p \"$name\")\" = \"complete -F _viwo_complete $name\" ] || exit 3; "
		    "_viwo_complete; printf '%s\\n' \"${COMPREPLY[@]}\"";
		Words arguments{VIWO_SOURCE_DIR "/share/bash-completion/viwo", folder_.path()};
		arguments.insert(arguments.end(), words.begin(), words.end());
		const ProgramResult result = bash(script, arguments);
		EXPECT_EQ(result.status, 0) << result.err;
		EXPECT_EQ(result.err, "");
		Words reply = lines(result.out);
		if (reply == Words{""}) reply.clear();
		return reply;
	}

	TempFolder folder_;
};

TEST_F(Completion, OptionsOfTheProgram)
{
	EXPECT_EQ(offered({"viwo-odometry", "--mo"}), Words{"--mode"});
	EXPECT_EQ(offered({"viwo-odometry", "--from", "3", "--pose"}), Words{"--pose-frame"});
	EXPECT_EQ(offered({"viwo-odometry", "--al"}), Words{"--allow-truncated"});
	EXPECT_EQ(offered({"viwo-odometry", "--no-such"}), Words{});
	EXPECT_EQ(offered({"viwo-odometry", "--print"}), Words{}) << "not for users";
	for (const std::string& program : allPrograms()) EXPECT_EQ(offered({program, "--versi"}), Words{"--version"}) << program;
}

TEST_F(Completion, WordsOfAnOption)
{
	EXPECT_EQ(offered({"viwo-odometry", "--mode", ""}), (Words{"wheel", "wio", "vio", "viwo"}));
	EXPECT_EQ(offered({"viwo-odometry", "--mode", "v"}), (Words{"vio", "viwo"}));
	EXPECT_EQ(offered({"viwo-odometry", "--mode", "=", "w"}), (Words{"wheel", "wio"}));
	EXPECT_EQ(offered({"viwo-odometry", "--mode", "="}), (Words{"wheel", "wio", "vio", "viwo"}));
	EXPECT_EQ(offered({"viwo-octomap", "--sources", "scans,d"}), Words{"scans,depth"});
	EXPECT_EQ(offered({"viwo-octomap", "--sources", "scans,depth,"}), (Words{"scans,depth,clouds", "scans,depth,landmarks"}));
}

TEST_F(Completion, FilesByTheirNames)
{
	EXPECT_EQ(offered({"viwo-odometry", "-i", ""}), (Words{"a.rawlog", "b.rawlog", "runs"}));
	EXPECT_EQ(offered({"viwo-odometry", "--input", "a.rawlog", ""}), (Words{"a.rawlog", "b.rawlog", "runs"})) << "it takes several";
	EXPECT_EQ(offered({"viwo-odometry", "-i", "runs/"}), Words{"runs/c.rawlog"});
	EXPECT_EQ(offered({"viwo-odometry", "-c", "m"}), Words{"my robot.ini"});
	EXPECT_EQ(offered({"viwo-odometry", "-o", ""}), Words{"runs"});
	EXPECT_EQ(offered({"viwo-plot", "--octomap", "run."}), (Words{"run.bt", "run.ot"}));
	EXPECT_EQ(offered({"viwo-info", "b"}), (Words{"b.bag", "b.rawlog"}));
	for (const char* command : {"estimate", "allan"})
	{
		EXPECT_EQ(offered({"viwo-calibrate", command, "-i", ""}), (Words{"a.rawlog", "b.rawlog", "runs"})) << command;
		EXPECT_EQ(offered({"viwo-calibrate", command, "--rig", ""}), (Words{"my robot.ini", "runs"})) << command;
	}
	EXPECT_EQ(offered({"/usr/bin/viwo-info", "n"}), Words{"notes.txt"});
}

TEST_F(Completion, Commands)
{
	EXPECT_EQ(offered({"viwo-import", "ro"}), Words{"rosbag"});
	EXPECT_EQ(offered({"viwo-import", "rosbag", "--auto", ""}), (Words{"b.bag", "runs"}));
	EXPECT_EQ(offered({"viwo-import", "rosbag", "--rec"}), Words{"--record-time"});
	EXPECT_EQ(offered({"viwo-import", "euroc", "--rec"}), Words{}) << "an option of rosbag";
	EXPECT_EQ(offered({"viwo-import", "euroc", "--qui"}), Words{"--quiet"}) << "of all commands";
	EXPECT_EQ(offered({"viwo-import", "rosbag", "b.bag", "-o", "ro"}), Words{}) << "a file, not a command";
	EXPECT_EQ(offered({"viwo-calibrate", "import", "--odom", "0", "0.3", "-0.1", "90", "-90", "9"}), Words{}) << "the sixth number";
	EXPECT_EQ(offered({"viwo-calibrate", "import", "--odom", "0", "0.3", "-0.1", "90", "-90", "90", "--ouT"}), Words{});
	EXPECT_EQ(offered({"viwo-calibrate", "import", "--odom", "0", "0.3", "-0.1", "90", "-90", "90", "--ou"}), Words{"--output"});
}
}  // namespace
}  // namespace viwo::testing
