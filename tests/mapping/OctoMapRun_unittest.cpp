#include "RunProgram.h"
#include "ScanRoom.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/COctoMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/serialization/CArchive.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <viwo/core/MrptPose.h>
#include <viwo/mapping/OccupancyImage.h>
#include <viwo/mapping/OctoMapRun.h>
#include <viwo/rawlog/RawlogReader.h>

#include <gtest/gtest.h>

#include <cstring>
#include <iostream>
#include <sstream>

namespace viwo
{
namespace
{
using namespace testing;
using octomap::OcTree;

OctoMapRunOptions optionsFor(const ScanRoomFiles& files, const std::string& output)
{
	OctoMapRunOptions options;
	options.rawlog = files.rawlog;
	options.trajectory = files.tum;
	options.output = files.folder.file(output);
	options.threads = 2;
	return options;
}

std::unique_ptr<OcTree> readTree(const std::string& path)
{
	if (path.substr(path.size() - 3) == ".bt")
	{
		auto tree = std::make_unique<OcTree>(0.1);
		EXPECT_TRUE(tree->readBinary(path)) << path;
		return tree;
	}
	std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(path));
	EXPECT_NE(dynamic_cast<OcTree*>(tree.get()), nullptr) << path;
	return std::unique_ptr<OcTree>(dynamic_cast<OcTree*>(tree.release()));
}

char stateAt(const OcTree& tree, const octomap::point3d& p)
{
	const auto* node = tree.search(p);
	return !node ? 'u' : tree.isNodeOccupied(node) ? 'o' : 'f';
}

/** Voxels of `tree` whose state is another one in `other`; unknown ones beside known ones included. */
size_t differences(const OcTree& tree, const OcTree& other)
{
	size_t count = 0;
	OcTree leaves(tree);
	leaves.expand();
	const float step = static_cast<float>(tree.getResolution());
	for (auto leaf = leaves.begin_leafs(), end = leaves.end_leafs(); leaf != end; ++leaf)
		for (const octomap::point3d& d : {octomap::point3d(0, 0, 0), octomap::point3d(step, 0, 0), octomap::point3d(0, 0, step)})
			count += stateAt(leaves, leaf.getCoordinate() + d) != stateAt(other, leaf.getCoordinate() + d);
	return count;
}

bool equalLogOdds(const OcTree& a, const OcTree& b)
{
	return a == b;
}

/** MRPT's class reads the .bt format as a part of its own serialized form: an empty map's, with our file in the place of its own. */
void readIntoMrpt(const std::string& bt, mrpt::maps::COctoMap& map)
{
	mrpt::io::CMemoryStream empty;
	mrpt::serialization::archiveFrom(empty) << map;
	const std::string form(static_cast<const char*>(empty.getRawBufferData()), empty.getTotalBytesCount());
	const size_t begin = form.find("# Octomap OcTree binary file");
	ASSERT_NE(begin, std::string::npos);
	const auto length = static_cast<uint32_t>(bt.size());
	std::string filled = form.substr(0, begin - sizeof length);
	filled.append(reinterpret_cast<const char*>(&length), sizeof length);
	filled += bt + form.back();
	mrpt::io::CMemoryStream stream(filled.data(), filled.size());
	mrpt::serialization::archiveFrom(stream) >> map;
}

std::string tool(const std::string& name)
{
	return "/usr/bin/" + name;
}
}  // namespace

TEST(OctoMapRun, DefaultsAreLiboctomapsSequentialInsertion)
{
	ScanRoom room;
	room.noise_m = 0.01;
	const ScanRoomFiles files(room);
	OctoMapRunOptions options = optionsFor(files, "map.ot");
	const OctoMapRunResult result = runOctoMap(options);
	EXPECT_EQ(result.used, 40u);

	OcTree expected(0.05);
	const Trajectory trajectory = Trajectory::loadTum(files.tum);
	RawlogReader reader(files.rawlog);
	while (const auto observation = reader.next())
	{
		const auto& scan = dynamic_cast<const mrpt::obs::CObservation2DRangeScan&>(*observation);
		const Pose3 T_WL = *trajectory.at(nanosecondsOf(scan.timestamp), 1) * fromMrpt(scan.sensorPose);
		octomap::Pointcloud cloud;
		for (size_t i = 0; i < scan.getScanSize(); ++i)
		{
			const double angle =
			    (static_cast<double>(i) / static_cast<double>(scan.getScanSize() - 1) - 0.5) * static_cast<double>(scan.aperture);
			const Eigen::Vector3d p =
			    T_WL.R * (static_cast<double>(scan.getScanRange(i)) * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)) + T_WL.p;
			cloud.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
		}
		const Eigen::Vector3f origin = T_WL.p.cast<float>();
		expected.insertPointCloud(cloud, {origin.x(), origin.y(), origin.z()});
	}
	expected.write(files.folder.file("expected.ot"));
	EXPECT_EQ(readFile(options.output), readFile(files.folder.file("expected.ot")));
}

TEST(OctoMapRun, SameBytesOnEveryRunAndForAnyNumberOfThreads)
{
	const ScanRoomFiles files;
	std::string first;
	for (const int threads : {1, 2, 2, 5})
	{
		OctoMapRunOptions options = optionsFor(files, "map.bt");
		options.both = true;
		options.threads = threads;
		options.ply = files.folder.file("map.ply");
		options.grid = files.folder.file("map.yaml");
		options.scan_graph = files.folder.file("map.log");
		runOctoMap(options);
		std::string all;
		for (const char* name : {"map.bt", "map.ot", "map.ply", "map.yaml", "map.pgm", "map.log"})
		{
			const std::string bytes = readFile(files.folder.file(name));
			EXPECT_FALSE(bytes.empty()) << name;
			all += bytes;
		}
		if (first.empty()) first = all;
		EXPECT_EQ(all, first) << threads << " threads";
	}
}

TEST(OctoMapRun, OctomapToolsReadBothFormats)
{
	const ScanRoomFiles files;
	OctoMapRunOptions options = optionsFor(files, "map.ot");
	options.both = true;
	runOctoMap(options);
	const std::string ot = files.folder.file("map.ot"), bt = files.folder.file("map.bt");
	const auto whole = readTree(ot), binary = readTree(bt);
	EXPECT_EQ(differences(*whole, *binary), 0u) << ".bt: free, occupied and unknown as in .ot";
	EXPECT_EQ(differences(*binary, *whole), 0u);

	const auto run = [](const std::string& name, const std::vector<std::string>& arguments)
	{
		const ProgramResult result = runProgram(tool(name), arguments);
		EXPECT_EQ(result.status, 0) << name << ": " << result.out << result.err;
		return result;
	};
	run("convert_octree", {ot, files.folder.file("again.ot")});
	EXPECT_TRUE(equalLogOdds(*readTree(files.folder.file("again.ot")), *whole)) << "convert_octree .ot -> .ot keeps the log-odds";
	run("convert_octree", {bt, files.folder.file("of_bt.ot")});
	EXPECT_EQ(differences(*readTree(files.folder.file("of_bt.ot")), *whole), 0u);
	run("convert_octree", {ot, files.folder.file("of_ot.bt")});
	EXPECT_EQ(differences(*readTree(files.folder.file("of_ot.bt")), *whole), 0u);
	run("edit_octree", {"-o", files.folder.file("edited.bt"), bt});
	EXPECT_EQ(differences(*readTree(files.folder.file("edited.bt")), *whole), 0u);
	const ProgramResult compared = run("compare_octrees", {ot, files.folder.file("again.ot")});
	std::cout << "[measured] compare_octrees: " << compared.out.substr(compared.out.rfind("KL")) << std::flush;
	EXPECT_NE(compared.out.find("KLD: 0\n"), std::string::npos) << compared.out;
	run("bt2vrml", {bt});
	EXPECT_NE(readFile(bt + ".wrl").find("VRML"), std::string::npos);
}

TEST(OctoMapRun, MrptReadsTheBinaryFormat)
{
	const ScanRoomFiles files;
	OctoMapRunOptions options = optionsFor(files, "map.bt");
	options.both = true;
	runOctoMap(options);
	mrpt::maps::COctoMap map;
	readIntoMrpt(readFile(options.output), map);
	const auto whole = readTree(files.folder.file("map.ot"));
	OcTree leaves(*whole);
	leaves.expand();
	size_t wrong = 0;
	for (auto leaf = leaves.begin_leafs(), end = leaves.end_leafs(); leaf != end; ++leaf)
	{
		double occupied = -1;
		const bool known = map.getPointOccupancy(static_cast<float>(leaf.getX()), static_cast<float>(leaf.getY()),
		                                         static_cast<float>(leaf.getZ()), occupied);
		wrong += !known || (occupied > 0.5) != leaves.isNodeOccupied(*leaf);
	}
	EXPECT_EQ(wrong, 0u);
}

TEST(OctoMapRun, ABoxThatMovesAwayLeavesFreeSpace)
{
	ScanRoom room;
	room.scans = 80;
	room.speed_m_s = 0.05;
	room.yaw_rate_rad_s = 0;
	const FloorBox first{1.5, -0.5, 2.1, 0.1}, second{1.5, 1.5, 2.1, 2.1};
	room.box = [&](double t_s) { return std::optional<FloorBox>(t_s < 3 ? first : second); };
	const auto occupiedIn = [](const OcTree& tree, const FloorBox& b)
	{
		int count = 0, known = 0;
		for (double x = b.min_x - 0.025; x < b.max_x + 0.05; x += 0.05)
			for (double y = b.min_y - 0.025; y < b.max_y + 0.05; y += 0.05)
			{
				const char state = stateAt(tree, {static_cast<float>(x), static_cast<float>(y), 0.2f});
				count += state == 'o';
				known += state != 'u';
			}
		return std::pair(count, known);
	};
	ScanRoom before = room;
	before.scans = 30;
	const ScanRoomFiles part(before), whole(room);
	runOctoMap(optionsFor(part, "map.ot"));
	runOctoMap(optionsFor(whole, "map.ot"));
	const auto then = readTree(part.folder.file("map.ot")), now = readTree(whole.folder.file("map.ot"));
	const auto [first_then, known_then] = occupiedIn(*then, first);
	const auto [first_now, known_now] = occupiedIn(*now, first);
	const auto [second_now, known_second] = occupiedIn(*now, second);
	std::cout << "[measured] voxels occupied where the box stood: " << first_then << " while it was there, " << first_now << " of "
	          << known_now << " known at the end; " << second_now << " at its new place\n";
	EXPECT_GT(first_then, 5);
	EXPECT_EQ(first_now, 0);
	EXPECT_GE(known_now, 13 * 13);
	EXPECT_GT(second_now, 5);
}

TEST(OctoMapRun, MotionDuringTheSweepIsUndone)
{
	ScanRoom room;
	room.sweep_s = 0.08;
	room.speed_m_s = 0.8;
	room.yaw_rate_rad_s = 0.9;
	room.scans = 30;
	const ScanRoomFiles files(room);
	const auto strayed = [&](double scan_duration_s)
	{
		OctoMapRunOptions options = optionsFor(files, "map.ot");
		options.rays.scan_duration_s = scan_duration_s;
		runOctoMap(options);
		const auto tree = readTree(options.output);
		size_t stray = 0, occupied = 0;
		for (auto leaf = tree->begin_leafs(), end = tree->end_leafs(); leaf != end; ++leaf)
		{
			if (!tree->isNodeOccupied(*leaf)) continue;
			++occupied;
			const double off = std::max(std::abs(leaf.getX()) - 4, std::abs(leaf.getY()) - 3);
			stray += std::abs(off) > 0.05;
		}
		return static_cast<double>(stray) / static_cast<double>(occupied);
	};
	const double without = strayed(0), with = strayed(0.08);
	std::cout << "[measured] occupied voxels off the walls: " << 100 * without << " % at once, " << 100 * with << " % de-skewed\n";
	EXPECT_GT(without, 0.1);
	EXPECT_EQ(with, 0);
}

TEST(OctoMapRun, FlaggedPosesAreLeftOut)
{
	const ScanRoomFiles files;
	std::string csv = "# frame: O\nt_s,x_x,flag\n";
	for (int i = 0; i < 40; ++i)
		csv += std::to_string(1700000000 + i / 10) + "." + std::to_string(i % 10) + "00000000,1e-4," +
		       (i < 10   ? "odometry_only"
		        : i < 15 ? "degenerate"
		                 : "good") +
		       "\n";
	writeFile(files.folder.file("flags.csv"), csv);
	OctoMapRunOptions options = optionsFor(files, "map.bt");
	options.flags = files.folder.file("flags.csv");
	const OctoMapRunResult result = runOctoMap(options);
	EXPECT_EQ(result.flagged, 10u);
	EXPECT_EQ(result.used, 30u);
	options.bad_flags = {"odometry_only", "degenerate"};
	EXPECT_EQ(runOctoMap(options).flagged, 15u);
}

TEST(OctoMapRun, GridIsWhatMapServerAndMrptRead)
{
	const ScanRoomFiles files;
	OctoMapRunOptions options = optionsFor(files, "map.bt");
	options.grid = files.folder.file("grid.yaml");
	runOctoMap(options);
	const std::string pgm = readFile(files.folder.file("grid.pgm"));
	std::istringstream header(pgm);
	std::string magic;
	int columns = 0, rows = 0, most = 0;
	header >> magic >> columns >> rows >> most;
	ASSERT_EQ(magic, "P5");
	const size_t begin = static_cast<size_t>(header.tellg()) + 1;
	ASSERT_EQ(pgm.size(), begin + static_cast<size_t>(columns) * static_cast<size_t>(rows));

	const ProgramResult read = runProgram(tool("ros-map-yaml2mrpt"), {"-i", options.grid, "-d", files.folder.path(), "-w"});
	ASSERT_EQ(read.status, 0) << read.out << read.err;
	mrpt::maps::COccupancyGridMap2D grid;
	mrpt::io::CFileGZInputStream file(files.folder.file("grid.gridmap.gz"));
	mrpt::serialization::archiveFrom(file) >> grid;
	ASSERT_EQ(static_cast<int>(grid.getSizeX()), columns);
	ASSERT_EQ(static_cast<int>(grid.getSizeY()), rows);
	size_t counts[3] = {0, 0, 0}, different = 0;
	for (int y = 0; y < rows; ++y)
		for (int x = 0; x < columns; ++x)
		{
			const auto cell = static_cast<uint8_t>(
			    pgm[begin + static_cast<size_t>(rows - 1 - y) * static_cast<size_t>(columns) + static_cast<size_t>(x)]);
			const float free = grid.getCell(x, y);
			const uint8_t expected = free < 0.35f   ? OccupancyImage::kOccupied
			                         : free > 0.65f ? OccupancyImage::kFree
			                                        : OccupancyImage::kUnknown;
			different += cell != expected;
			++counts[cell == OccupancyImage::kOccupied ? 0 : cell == OccupancyImage::kFree ? 1 : 2];
		}
	std::cout << "[measured] cells: " << counts[0] << " occupied, " << counts[1] << " free, " << counts[2] << " unknown; " << different
	          << " read otherwise by ros-map-yaml2mrpt\n";
	EXPECT_EQ(different, 0u);
	EXPECT_GT(counts[0], 200u);
	EXPECT_GT(counts[1], 10000u);
	// The room's walls are where they are: 8 x 6 m, and cells begin at multiples of the resolution.
	EXPECT_NEAR(columns * 0.05, 8, 0.15);
	EXPECT_NEAR(rows * 0.05, 6, 0.15);
}

TEST(OctoMapRun, PlyHoldsTheOccupiedVoxels)
{
	const ScanRoomFiles files;
	OctoMapRunOptions options = optionsFor(files, "map.ot");
	options.ply = files.folder.file("map.ply");
	const OctoMapRunResult result = runOctoMap(options);
	const std::string ply = readFile(options.ply);
	const size_t body = ply.find("end_header\n") + 11;
	ASSERT_NE(ply.find("format binary_little_endian 1.0"), std::string::npos);
	ASSERT_NE(ply.find("element vertex " + std::to_string(result.occupied) + "\n"), std::string::npos);
	ASSERT_EQ(ply.size() - body, result.occupied * 12);
	const auto tree = readTree(options.output);
	for (size_t i = 0; i < result.occupied; ++i)
	{
		float p[3];
		std::memcpy(p, ply.data() + body + 12 * i, 12);
		ASSERT_EQ(stateAt(*tree, {p[0], p[1], p[2]}), 'o');
	}
}

TEST(OctoMapRun, ScanGraphForLog2graph)
{
	const ScanRoomFiles files;
	OctoMapRunOptions options = optionsFor(files, "map.ot");
	options.scan_graph = files.folder.file("scans.log");
	options.resolution_m = 0.1;
	runOctoMap(options);
	ASSERT_EQ(runProgram(tool("log2graph"), {options.scan_graph, files.folder.file("scans.graph")}).status, 0);
	const ProgramResult built =
	    runProgram(tool("graph2tree"), {"-i", files.folder.file("scans.graph"), "-o", files.folder.file("graph.bt"), "-res", "0.1"});
	ASSERT_EQ(built.status, 0) << built.out << built.err;
	const auto ours = readTree(options.output), theirs = readTree(files.folder.file("graph.bt.ot"));
	const size_t different = differences(*ours, *theirs);
	std::cout << "[measured] " << different << " voxels differ from graph2tree's, of " << ours->getNumLeafNodes() << "\n";
	EXPECT_LE(different, ours->getNumLeafNodes() / 100) << "points pass through text there";
}

TEST(OctoMapRun, ColoursByHeight)
{
	const ScanRoomFiles files;
	OctoMapRunOptions options = optionsFor(files, "map.ot");
	options.colours = VoxelColours::height;
	runOctoMap(options);
	std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(options.output));
	const auto* coloured = dynamic_cast<const octomap::ColorOcTree*>(tree.get());
	ASSERT_NE(coloured, nullptr);
	const auto* wall = coloured->search(4.01, 0, 0.2);
	ASSERT_TRUE(wall && coloured->isNodeOccupied(wall));
	EXPECT_EQ(wall->getColor(), octomap::ColorOcTreeNode::Color(0, 0, 255)) << "all at one height: the lowest";
}
}  // namespace viwo
