#include "RunProgram.h"
#include "ScanRoom.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace viwo
{
namespace
{
using namespace testing;
namespace fs = std::filesystem;

const std::string kProgram = VIWO_BINARY_DIR "/bin/viwo-octomap";

/** The folder's files besides the input's. */
std::vector<std::string> madeIn(const TempFolder& folder)
{
	std::vector<std::string> names;
	for (const auto& entry : fs::directory_iterator(folder.path()))
		if (entry.path().filename().string()[0] == 'm') names.push_back(entry.path().filename().string());
	return names;
}

/** One clear line that holds the parts, a status other than 0, and nothing half-written. */
void expectRefused(const ScanRoomFiles& files, const ProgramResult& result, const std::vector<std::string>& parts)
{
	EXPECT_TRUE(result.status == 1 || result.status == 2) << result.status;
	EXPECT_EQ(result.errorLines(), 1u) << result.err;
	EXPECT_EQ(result.out, "");
	for (const std::string& part : parts)
		EXPECT_NE(result.err.find(part), std::string::npos) << "'" << part << "' is not in: " << result.err;
	EXPECT_EQ(madeIn(files.folder), std::vector<std::string>());
}
}  // namespace

TEST(OctoMapProgram, WritesAMapAndNothingElseInAPipe)
{
	const ScanRoomFiles files;
	const ProgramResult result = runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", files.folder.file("map.bt"), "--both"});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_EQ(result.err, "");
	EXPECT_NE(result.out.find("40 observations"), std::string::npos) << result.out;
	EXPECT_EQ(madeIn(files.folder).size(), 2u);
}

TEST(OctoMapProgram, BadTrajectories)
{
	const ScanRoomFiles files;
	const auto withTrajectory = [&](const std::string& tum)
	{
		writeFile(files.folder.file("t.tum"), tum);
		return runProgram(kProgram, {"-i", files.rawlog, "-t", files.folder.file("t.tum"), "-o", files.folder.file("map.bt")});
	};
	expectRefused(files, withTrajectory("1000 0 0 0 0 0 0 1\n1001 0 0 0 0 0 0 1\n"), {"t.tum", "no pose at the time", "1700000000"});
	expectRefused(files, withTrajectory(""), {"t.tum", "empty"});
	expectRefused(files, withTrajectory("# nothing\n"), {"t.tum", "no pose"});
	expectRefused(files, withTrajectory("1001 0 0 0 0 0 0 1\n1000 0 0 0 0 0 0 1\n"), {"t.tum:2", "sort"});
	expectRefused(files, withTrajectory("1000 0 0 0 0 0 0 1\n1001 0 0 0 0 0 0 2\n"), {"t.tum:2", "quaternion"});
	expectRefused(files, withTrajectory("1000 0 0 0 0 0 1\n"), {"t.tum:1", "columns"});
	expectRefused(files, runProgram(kProgram, {"-i", files.rawlog, "-t", "absent.tum", "-o", files.folder.file("map.bt")}), {"absent.tum"});
}

TEST(OctoMapProgram, BadOutputs)
{
	const ScanRoomFiles files;
	const auto to = [&](const std::string& output, const std::vector<std::string>& more = {})
	{
		std::vector<std::string> arguments{"-i", files.rawlog, "-t", files.tum, "-o", output};
		arguments.insert(arguments.end(), more.begin(), more.end());
		return runProgram(kProgram, arguments);
	};
	expectRefused(files, to(files.folder.file("no/map.bt")), {"no/map.bt", "no folder"});
	expectRefused(files, to("/proc/map.bt"), {"/proc/map.bt", "cannot write"});
	expectRefused(files, to(files.folder.file("map.pcd")), {"map.pcd", ".bt or .ot"});
	expectRefused(files, to(files.folder.file("map")), {".bt or .ot"});
	expectRefused(files, to(files.folder.file("map.bt"), {"--colour", "height"}), {".ot"});
	expectRefused(files, to(files.folder.file("map.bt"), {"--to-grid", files.folder.file("map.pgm")}), {".yaml"});
	expectRefused(files,
	              to(files.folder.file("map.bt"), {"--to-grid", files.folder.file("map.yaml"), "--grid-min-z", "5", "--grid-max-z", "6"}),
	              {"nothing between"});
}

TEST(OctoMapProgram, BadNumbers)
{
	const ScanRoomFiles files;
	for (const std::vector<std::string>& bad : {std::vector<std::string>{"--resolution", "0"},
	                                            {"--resolution", "-0.1"},
	                                            {"--resolution", "nan"},
	                                            {"--hit", "0.4"},
	                                            {"--subsample", "0"},
	                                            {"--sources", "radar"},
	                                            {"--sources", "landmarks"}})
	{
		std::vector<std::string> arguments{"-i", files.rawlog, "-t", files.tum, "-o", files.folder.file("map.bt")};
		arguments.insert(arguments.end(), bad.begin(), bad.end());
		expectRefused(files, runProgram(kProgram, arguments), {bad[0].substr(2, 6)});
	}
}

TEST(OctoMapProgram, NothingToMap)
{
	const ScanRoomFiles files;
	const std::string map = files.folder.file("map.bt");
	expectRefused(files, runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", map, "--sources", "depth"}),
	              {"x.rawlog", "nothing to map", "LIDAR"});
	expectRefused(files, runProgram(kProgram, {"-i", "absent.rawlog", "-t", files.tum, "-o", map}), {"absent.rawlog"});
	writeFile(files.folder.file("flags.csv"), "t_s,flag\n1700000000.000000000,odometry_only\n1,good\n");
	expectRefused(files, runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", map, "--flags", files.folder.file("absent.csv")}),
	              {"absent.csv"});
	writeFile(files.folder.file("other.csv"), "t_s,flag\n1,good\n");
	expectRefused(files, runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", map, "--flags", files.folder.file("other.csv")}),
	              {"other.csv", "another trajectory"});
}

TEST(OctoMapProgram, InterruptedItLeavesNothing)
{
	ScanRoom room;
	room.scans = 3000;
	room.yaw_rate_rad_s = 0.3;
	const ScanRoomFiles files(room);
	const std::string map = files.folder.file("map.bt");
	const ProgramResult result = runAndSignal(
	    kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", map, "--resolution", "0.02", "--threads", "1"}, 2, map + ".part", 0.2);
	expectRefused(files, result, {"interrupted"});
}

TEST(OctoMapProgram, FullDisk)
{
	const ScanRoomFiles files;
	// A limit on the size of files stands for a disk that fills up: writing fails in the same place.
	const std::string command = "ulimit -f 2; trap '' XFSZ; exec " + quoted(kProgram) + " -i " + quoted(files.rawlog) + " -t " +
	                            quoted(files.tum) + " -o " + quoted(files.folder.file("map.ot"));
	expectRefused(files, runProgram("/bin/bash", {"-c", command}), {"map.ot", "cannot write"});
}
}  // namespace viwo
