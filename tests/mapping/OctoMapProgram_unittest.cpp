#include "Refused.h"
#include "ScanRoom.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <viwo/mapping/Landmarks.h>
#include <viwo/mapping/OccupancyImage.h>
#include <viwo/rawlog/RawlogReader.h>

#include <filesystem>
#include <iostream>

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

/** And nothing half-written. */
void expectRefused(const ScanRoomFiles& files, const ProgramResult& result, const std::vector<std::string>& parts)
{
	testing::expectRefused(result, parts);
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
	expectRefused(files, to(files.folder.file("map.bt"), {"--to-ply", files.folder.file("map.bt")}), {"map.bt", "written twice"});
	expectRefused(files, to(files.folder.file("map.bt"), {"--both", "--to-ply", files.folder.file("map.ot")}), {"map.ot", "written twice"});
	expectRefused(files, to(files.rawlog + "/map.bt"), {"x.rawlog/map.bt", "no folder"});
	if (geteuid() == 0) return;  // root writes everywhere
	fs::permissions(files.folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
	expectRefused(files, to(files.folder.file("map.bt")), {"map.bt", "cannot write", "permissions"});
	fs::permissions(files.folder.path(), fs::perms::owner_all);
}

TEST(OctoMapProgram, BadNumbers)
{
	const ScanRoomFiles files;
	for (const std::vector<std::string>& bad : {std::vector<std::string>{"--resolution", "0"},
	                                            {"--resolution", "nan"},
	                                            {"--max-range", "0"},
	                                            {"--max-range", "nan"},
	                                            {"--max-range", "2", "--min-range", "2"},
	                                            {"--hit", "0.4"},
	                                            {"--occupancy-thres", "0.98"},
	                                            {"--scan-duration", "1e300"},
	                                            {"--stamp-position", "1.1", "--scan-duration", "0.1"},
	                                            {"--pointcloud-min-z", "nan"},
	                                            {"--pointcloud-max-z", "-1", "--pointcloud-min-z", "0"},
	                                            {"--grid-max-z", "1"},
	                                            {"--subsample", "0"},
	                                            {"--sources", "radar"},
	                                            {"--sources", "landmarks"},
	                                            {"--landmarks", "out", "--sources", "scans"},
	                                            {"--bad-flags", "degenerate"}})
	{
		std::vector<std::string> arguments{"-i", files.rawlog, "-t", files.tum, "-o", files.folder.file("map.bt")};
		arguments.insert(arguments.end(), bad.begin(), bad.end());
		expectRefused(files, runProgram(kProgram, arguments), {bad[0]});
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
	expectRefused(files,
	              runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", map, "--flags", files.folder.file("flags.csv"),
	                                    "--bad-flags", "good,odometry-only"}),
	              {"--bad-flags", "odometry-only", "odometry_only"});
	writeFile(files.folder.file("other.csv"), "t_s,flag\n1,good\n");
	expectRefused(files, runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", map, "--flags", files.folder.file("other.csv")}),
	              {"other.csv", "another trajectory"});
}

TEST(OctoMapProgram, ScansWithoutTimes)
{
	const ScanRoomFiles files;
	for (const bool some : {true, false})
	{
		const std::string rawlog = files.folder.file("unstamped.rawlog"), map = files.folder.file("map.bt");
		RawlogReader reader(files.rawlog);
		RawlogWriter writer(rawlog);
		for (int i = 0; const auto observation = reader.next(); ++i)
		{
			if (!some || i >= 30) observation->timestamp = INVALID_TIMESTAMP;
			writer.write(*observation);
		}
		writer.close();
		const ProgramResult result = runProgram(kProgram, {"-i", rawlog, "-t", files.tum, "-o", map});
		if (!some) return expectRefused(files, result, {"unstamped.rawlog", "none of the 40 observations has a stamp"});
		expectDone(result);
		EXPECT_NE(result.err.find("10 observations left out: they have no stamp"), std::string::npos) << result.err;
		const ProgramResult copy = runProgram(VIWO_BINARY_DIR "/bin/viwo-convert",
		                                      {"rawlog", "-i", rawlog, "-t", files.tum, "-o", files.folder.file("copy.rawlog")});
		EXPECT_NE(copy.err.find("10 observations left out"), std::string::npos) << copy.err;
		std::filesystem::remove(map);
	}
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
	for (const char* name : {"map.bt", "map.ot", "map.ply"})
	{
		const std::string full = files.folder.file(name);
		std::vector<std::string> arguments{"-i", files.rawlog, "-t", files.tum, "--threads", "2"};
		const bool is_tree = full.substr(full.size() - 2) == "bt" || full.substr(full.size() - 2) == "ot";
		if (!is_tree) arguments.insert(arguments.end(), {"--to-ply", full});
		arguments.insert(arguments.end(), {"--both", "-o", is_tree ? full : files.folder.file("map.bt")});
		fs::create_symlink("/dev/full", full);
		const ProgramResult result = runProgram(kProgram, arguments);
		fs::remove(full);
		expectRefused(files, result, {"/dev/full", "cannot write", "is the disk full?"});
	}
	// A limit on the size of files: the temporary file is there when writing fails.
	const std::string command = "ulimit -f 2; trap '' XFSZ; exec " + quoted(kProgram) + " -i " + quoted(files.rawlog) + " -t " +
	                            quoted(files.tum) + " -o " + quoted(files.folder.file("map.ot"));
	expectRefused(files, runProgram("/bin/bash", {"-c", command}), {"map.ot", "cannot write"});
}

/** Lasers of CARMEN logs are at z = 0, below the usual slice of a grid. */
TEST(OctoMapProgram, AFlatMapsGridIsAllOfIt)
{
	ScanRoom room;
	room.T_OL.p.z() = 0;
	const ScanRoomFiles files(room), higher;
	const auto gridOf = [](const ScanRoomFiles& f)
	{
		const std::string grid = f.folder.file("map.yaml");
		expectDone(runProgram(kProgram, {"-i", f.rawlog, "-t", f.tum, "-o", f.folder.file("map.bt"), "--to-grid", grid}));
		return readFile(f.folder.file("map.pgm"));
	};
	EXPECT_GT(gridOf(files).size(), 10000u);
	EXPECT_EQ(gridOf(files), gridOf(higher));
}

/** With landmarks the same map is not flat, and the laser at z = 0 is below the grid: that is said. */
TEST(OctoMapProgram, ScansThatTheGridDoesNotShow)
{
	ScanRoom room;
	room.T_OL.p.z() = 0;
	const ScanRoomFiles files(room);
	const std::string dir = files.folder.file("out");
	fs::create_directory(dir);
	fs::copy_file(files.tum, dir + "/trajectory.tum");
	saveLandmarks(dir + "/landmarks.ply", {{1, {1, 0, 1.5}, 0.01}});
	writeFile(dir + "/keyframes.csv", "t_ns,x,y,z,qx,qy,qz,qw\n1700000000200000000,0,-1,0.3,0,0,0,1\n");
	writeFile(dir + "/landmark_observations.csv", "landmark_id,t_ns\n1,1700000000200000000\n");
	std::vector<std::string> arguments{"-i",          files.rawlog,
	                                   "-t",          files.tum,
	                                   "-o",          files.folder.file("map.bt"),
	                                   "--landmarks", dir,
	                                   "--to-grid",   files.folder.file("map.yaml")};
	const ProgramResult missed = runProgram(kProgram, arguments);
	expectDone(missed);
	EXPECT_NE(missed.err.find("40 planar scans lie outside"), std::string::npos) << missed.err;
	EXPECT_NE(missed.err.find("--grid-min-z"), std::string::npos) << missed.err;
	arguments.insert(arguments.end(), {"--grid-min-z", "0", "--to-ply", dir + "/landmarks.ply"});
	testing::expectRefused(runProgram(kProgram, arguments), {"landmarks.ply", "is an input"});
	arguments.resize(arguments.size() - 2);
	const ProgramResult seen = runProgram(kProgram, arguments);
	expectDone(seen);
	EXPECT_EQ(seen.err, "");
}

TEST(OctoMapProgram, HeightsWithoutAnythingLoseNoMap)
{
	const ScanRoomFiles files;
	const std::string map = files.folder.file("map.bt");
	const auto withHeights = [&](const std::string& low, const std::string& high)
	{
		return runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", map, "--to-grid", files.folder.file("map.yaml"),
		                             "--grid-min-z", low, "--grid-max-z", high});
	};
	const ProgramResult refused = withHeights("5", "6");
	testing::expectRefused(refused, {"map.yaml", "5.00 and 6.00 m", "0.20 and 0.25 m", "--grid-min-z", "map.bt is there"});
	EXPECT_EQ(madeIn(files.folder), std::vector<std::string>{"map.bt"});
	const std::string kept = readFile(map);
	expectDone(withHeights("0.2", "0.25"));
	EXPECT_EQ(readFile(map), kept);
	EXPECT_EQ(madeIn(files.folder).size(), 3u);
}

TEST(OctoMapProgram, ABoxThatMovesAwayIsClearedFromMapAndGrid)
{
	const FloorBox first{1.5, -0.5, 2.1, 0.1}, second{1.5, 1.5, 2.1, 2.1};
	const auto occupiedCells = [&](double until_s)
	{
		ScanRoom room;
		room.scans = static_cast<int>(10 * until_s);
		room.speed_m_s = 0.05;
		room.yaw_rate_rad_s = 0;
		room.box = [&](double t_s) { return std::optional<FloorBox>(t_s < 3 ? first : second); };
		const ScanRoomFiles files(room);
		const std::string grid = files.folder.file("map.yaml");
		expectDone(runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", files.folder.file("map.bt"), "--to-grid", grid}));
		const OccupancyImage image = loadMapServer(grid);
		const auto within = [&](const FloorBox& b)
		{
			int n = 0;
			for (int y = 0; y < image.rows; ++y)
				for (int x = 0; x < image.columns; ++x)
				{
					const double x_m = image.min_x_m + (x + 0.5) * image.resolution_m, y_m = image.min_y_m + (y + 0.5) * image.resolution_m;
					const bool inside = x_m > b.min_x - 0.1 && x_m < b.max_x + 0.1 && y_m > b.min_y - 0.1 && y_m < b.max_y + 0.1;
					n += inside && image.cell(x, y) == OccupancyImage::kOccupied;
				}
			return n;
		};
		return std::pair(within(first), within(second));
	};
	const auto [first_then, second_then] = occupiedCells(3);
	const auto [first_now, second_now] = occupiedCells(8);
	std::cout << "[measured] occupied cells at the box's first and second place: " << first_then << ", " << second_then
	          << " before it moves, " << first_now << ", " << second_now << " at the end\n";
	EXPECT_GT(first_then, 5);
	EXPECT_EQ(second_then, 0);
	EXPECT_EQ(first_now, 0);
	EXPECT_GT(second_now, 5);
}

TEST(OctoMapProgram, SameBytesTwice)
{
	const ScanRoomFiles files;
	const auto bytes = [&](const std::string& threads)
	{
		const TempFolder out;
		std::string all;
		expectDone(
		    runProgram(kProgram, {"-i", files.rawlog, "-t", files.tum, "-o", out.file("m.bt"), "--both", "--to-ply", out.file("m.ply"),
		                          "--to-grid", out.file("m.yaml"), "--scan-graph", out.file("m.log"), "--threads", threads}));
		for (const char* name : {"m.bt", "m.ot", "m.ply", "m.yaml", "m.pgm", "m.log"}) all += readFile(out.file(name));
		return all;
	};
	const std::string first = bytes("2");
	EXPECT_GT(first.size(), 10000u);
	EXPECT_EQ(bytes("2"), first);
	EXPECT_EQ(bytes("1"), first);
}
}  // namespace viwo
