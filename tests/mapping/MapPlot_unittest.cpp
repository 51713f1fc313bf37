#include "ExpectError.h"
#include "Refused.h"
#include "ScanRoom.h"

#include <viwo/core/AtomicFile.h>
#include <viwo/mapping/MapPlot.h>
#include <viwo/mapping/OctoMapRun.h>
#include <viwo/mapping/OctreeFiles.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

namespace viwo
{
namespace
{
using namespace testing;

/** 4 x 2 m with an occupied cell at (1.05, 1.55). */
MapPlot smallPlot()
{
	MapPlot plot;
	plot.title = "A <map>";
	OccupancyImage map;
	map.columns = 40;
	map.rows = 20;
	map.resolution_m = 0.1;
	map.min_x_m = -1;
	map.min_y_m = 0;
	map.cells.assign(800, OccupancyImage::kFree);
	map.cell(20, 15) = OccupancyImage::kOccupied;
	plot.map = map;
	PlotLayer path{"drive", {255, 0, 0}, PlotLayer::Kind::path, {}};
	path.points_m = {{-0.5, 0.5}, {2.5, 0.5}};
	plot.layers.push_back(path);
	return plot;
}

size_t countPixels(const cv::Mat& picture, const cv::Vec3b& bgr)
{
	size_t n = 0;
	for (int y = 0; y < picture.rows; ++y)
		for (int x = 0; x < picture.cols; ++x) n += picture.at<cv::Vec3b>(y, x) == bgr;
	return n;
}

size_t count(const std::string& text, const std::string& part)
{
	size_t n = 0;
	for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
	return n;
}
}  // namespace

TEST(MapPlot, PngShowsMapPathGridAndBar)
{
	const TempFolder folder;
	saveMapPlot(folder.file("p.png"), smallPlot());
	const cv::Mat picture = cv::imread(folder.file("p.png"));
	ASSERT_FALSE(picture.empty());
	size_t red = 0, black = 0;
	for (int y = 0; y < picture.rows; ++y)
		for (int x = 0; x < picture.cols; ++x)
		{
			const cv::Vec3b c = picture.at<cv::Vec3b>(y, x);
			red += c[2] > 200 && c[0] < 60 && c[1] < 60;
			black += c[0] == 0 && c[1] == 0 && c[2] == 0;
		}
	// 22 pixels a cell: the path of 3 m is 660 pixels long and 2 wide, the cell 22 x 22.
	EXPECT_GT(red, 660u);
	EXPECT_NEAR(static_cast<double>(black), 22 * 22, 100) << "a line of the grid crosses it";
}

TEST(MapPlot, BeyondTheMapNothingIsKnown)
{
	const TempFolder folder;
	MapPlot plot = smallPlot();
	plot.layers[0].points_m = {{-3, 0.5}, {2.5, 0.5}};  // the map begins at -1 m
	saveMapPlot(folder.file("p.png"), plot);
	const cv::Mat picture = cv::imread(folder.file("p.png"));
	const double grey = static_cast<double>(countPixels(picture, {205, 205, 205})), cell = 15 * 15;
	EXPECT_NEAR(grey / cell, 20 * 20, 40) << "2 m x 2 m of unknown, less the lines of the grid";
	saveMapPlot(folder.file("p.svg"), plot);
	EXPECT_NE(readFile(folder.file("p.svg")).find("fill=\"#cdcdcd\""), std::string::npos);
}

TEST(MapPlot, SvgHasTheSameAndIsWellFormed)
{
	const TempFolder folder;
	saveMapPlot(folder.file("p.svg"), smallPlot());
	const std::string svg = readFile(folder.file("p.svg"));
	EXPECT_EQ(svg.rfind("<svg ", 0), 0u);
	EXPECT_EQ(count(svg, "<image "), 1u);
	EXPECT_NE(svg.find(">drive</text>"), std::string::npos);
	EXPECT_NE(svg.find("A &lt;map&gt;"), std::string::npos);
	EXPECT_NE(svg.find(">0.5 m</text>"), std::string::npos) << "bar of scale";
	EXPECT_NE(svg.find(">2.5</text>"), std::string::npos) << "metres of the grid";
	EXPECT_EQ(count(svg, "<svg"), count(svg, "</svg>"));
	EXPECT_EQ(count(svg, "<text"), count(svg, "</text>"));
}

TEST(MapPlot, SameBytes)
{
	const TempFolder folder;
	for (const char* name : {"a.png", "b.png", "a.svg", "b.svg"}) saveMapPlot(folder.file(name), smallPlot());
	EXPECT_EQ(readFile(folder.file("a.png")), readFile(folder.file("b.png")));
	EXPECT_EQ(readFile(folder.file("a.svg")), readFile(folder.file("b.svg")));
}

TEST(MapPlot, NothingToDraw)
{
	const TempFolder folder;
	expectError([&] { saveMapPlot(folder.file("a.png"), MapPlot()); }, {"nothing to draw"});
	expectError([&] { saveMapPlot(folder.file("a.gif"), smallPlot()); }, {"a.gif", ".png or .svg"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("a.png")));
}

TEST(MapPlot, APoseAloneIsADot)
{
	const TempFolder folder;
	MapPlot plot;
	PlotLayer path{"stands", {255, 0, 0}, PlotLayer::Kind::path, {{1, 2}}};
	for (int poses = 1; poses < 3; ++poses, path.points_m.push_back(path.points_m[0]))
	{
		plot.layers = {path};
		saveMapPlot(folder.file("p.svg"), plot);
		EXPECT_EQ(count(readFile(folder.file("p.svg")), "<circle "), 1u);
		saveMapPlot(folder.file("p.png"), plot);
		EXPECT_GT(countPixels(cv::imread(folder.file("p.png")), {0, 0, 255}), 80u) << "the dot, and the legend's line of 24 x 3 pixels";
	}
}

TEST(MapPlot, TextOfAnyBytes)
{
	const TempFolder folder;
	MapPlot plot = smallPlot();
	plot.title = "a\x01\xFF";
	plot.layers[0].name = "\x1B[31m";
	saveMapPlot(folder.file("p.png"), plot);
	saveMapPlot(folder.file("p.svg"), plot);
	const std::string svg = readFile(folder.file("p.svg"));
	EXPECT_NE(svg.find(">a\xEF\xBF\xBD\xEF\xBF\xBD</text>"), std::string::npos);
	EXPECT_EQ(svg.find('\x1B'), std::string::npos);
}

TEST(MapPlot, HugeExtents)
{
	const TempFolder folder;
	MapPlot plot = smallPlot();
	plot.layers[0].points_m.emplace_back(2000, 0.5);  // 20,010 cells of the map's
	saveMapPlot(folder.file("p.png"), plot);
	const cv::Mat picture = cv::imread(folder.file("p.png"));
	EXPECT_GT(picture.cols, 4000);
	EXPECT_LT(picture.cols, 6200);
	plot.layers[0].points_m.back().x() = 1e6;
	expectError([&] { saveMapPlot(folder.file("q.png"), plot); }, {"smaller than a pixel", "1000001 m"});
	plot.layers[0].points_m.back().x() = 1e300;
	expectError([&] { saveMapPlot(folder.file("q.png"), plot); }, {"drive", "1e+300"});
	plot.map.reset();
	expectError([&] { saveMapPlot(folder.file("q.svg"), plot); }, {"drive", "1e+300"});
	plot.layers[0].points_m.back().x() = 1e7;
	saveMapPlot(folder.file("p.svg"), plot);
	EXPECT_NE(readFile(folder.file("p.svg")).find(">10000000</text>"), std::string::npos);
}

TEST(MapPlot, CoarserMapsLoseNoObstacle)
{
	OccupancyImage map = *smallPlot().map;
	for (int x = 0; x < 3; ++x) map.cell(x, 0) = OccupancyImage::kUnknown;
	map.cell(37, 17) = map.cell(38, 17) = OccupancyImage::kUnknown;
	const OccupancyImage half = coarser(map, 3);
	EXPECT_EQ(half.columns, 14);
	EXPECT_EQ(half.rows, 7);
	EXPECT_DOUBLE_EQ(half.resolution_m, 0.3);
	EXPECT_EQ(half.cell(20 / 3, 15 / 3), OccupancyImage::kOccupied);
	EXPECT_EQ(std::count(half.cells.begin(), half.cells.end(), OccupancyImage::kOccupied), 1);
	EXPECT_EQ(std::count(half.cells.begin(), half.cells.end(), OccupancyImage::kUnknown), 0) << "each has a free cell, too";
}

TEST(MapPlot, NamesWithBlanks)
{
	const TempFolder folder;
	const OccupancyImage map = *smallPlot().map;
	saveMapServer(folder.file("first floor.yaml"), map);
	EXPECT_EQ(loadMapServer(folder.file("first floor.yaml")).cells, map.cells);
	EXPECT_NE(readFile(folder.file("first floor.yaml")).find("image: \"first floor.pgm\"\n"), std::string::npos);
	const ProgramResult read = runProgram("/usr/bin/ros-map-yaml2mrpt", {"-i", folder.file("first floor.yaml"), "-d", folder.path(), "-w"});
	EXPECT_EQ(read.status, 0) << read.out << read.err;
	EXPECT_TRUE(std::filesystem::exists(folder.file("first floor.gridmap.gz")));
}

TEST(MapPlot, DamagedMaps)
{
	const TempFolder folder;
	writeFile(folder.file("m.yaml"),
	          "image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\nnegate: 0\n");
	writeFile(folder.file("m.pgm"), "P5\n2000000000 2000000000\n255\nx");
	expectError([&] { loadMapServer(folder.file("m.yaml")); }, {"m.pgm", "ends too early"});
	writeFile(folder.file("m.yaml"),
	          "image: m.pgm\nresolution: 0.1\norigin: [1e300, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\nnegate: 0\n");
	expectError([&] { loadMapServer(folder.file("m.yaml")); }, {"m.yaml", "'origin'"});
}

/** A wall of 21 voxels at 0.2 m, and a voxel at 1 m: each is seen in the slice that it is in, and both in a view between two heights. */
TEST(PlotProgram, SlicesOfAnOctoMap)
{
	const TempFolder folder;
	octomap::OcTree tree(0.1);
	for (int x = 0; x <= 20; ++x)
	{
		tree.updateNode(octomap::point3d(0.1f * static_cast<float>(x) + 0.05f, 1.05f, 0.25f), true);
		for (int y = 0; y < 10; ++y)
			tree.updateNode(octomap::point3d(0.1f * static_cast<float>(x) + 0.05f, 0.1f * static_cast<float>(y) + 0.05f, 0.25f), false);
	}
	tree.updateNode(octomap::point3d(1.05f, 0.05f, 1.05f), true);
	tree.updateNode(octomap::point3d(2.05f, 1.05f, 1.05f), false);
	AtomicFile file(folder.file("m.ot"));
	writeOctree(file.stream(), tree, OctreeFormat::ot);
	file.commit();
	const auto blackCells = [&](const std::vector<std::string>& heights)
	{
		std::vector<std::string> arguments{"-o", folder.file("p.png"), "--octomap", folder.file("m.ot")};
		arguments.insert(arguments.end(), heights.begin(), heights.end());
		expectDone(runProgram(VIWO_BINARY_DIR "/bin/viwo-plot", arguments));
		const cv::Mat picture = cv::imread(folder.file("p.png"));
		return static_cast<double>(countPixels(picture, {0, 0, 0}));
	};
	const double wall = blackCells({"--min-z", "0.25", "--max-z", "0.25"}), voxel_and_free = blackCells({"--min-z", "1", "--max-z", "1.1"}),
	             both = blackCells({});
	// The views are of the same 2.1 m: cells have floor(900 / 21) pixels, of which lines of the grid take some.
	const double cell = 42 * 42;
	std::cout << "[measured] occupied cells in the pictures: " << wall / cell << ", " << both / cell << "\n";
	EXPECT_GT(wall / cell, 18.5);
	EXPECT_LE(wall / cell, 21);
	EXPECT_GT(voxel_and_free / cell, 0.8);
	EXPECT_NEAR((both - wall) / cell, 1, 0.2);
	const ProgramResult nothing = runProgram(
	    VIWO_BINARY_DIR "/bin/viwo-plot", {"-o", folder.file("q.png"), "--octomap", folder.file("m.ot"), "--min-z", "3", "--max-z", "4"});
	expectRefused(nothing, {"m.ot", "3.00 and 4.00 m", "0.20 and 1.10 m", "--min-z"});
}

/** Cut anywhere, or with the bytes of a tree without an end. */
TEST(PlotProgram, DamagedOctoMaps)
{
	const TempFolder folder;
	octomap::OcTree tree(0.1);
	octomap::ColorOcTree coloured(0.1);
	for (int i = 0; i < 50; ++i)
	{
		const octomap::point3d p(0.3f * static_cast<float>(i), 0.05f, 0.5f);
		tree.updateNode(p, i % 3 == 0);
		coloured.updateNode(p, i % 3 == 0);
	}
	const auto load = [&](const std::string& bytes)
	{
		writeFile(folder.file("m"), bytes);
		return loadProjection(folder.file("m"), {});
	};
	for (const OctreeFormat format : {OctreeFormat::ot, OctreeFormat::bt})
	{
		std::ostringstream plain, colours;
		writeOctree(plain, tree, format);
		writeOctree(colours, coloured, format);
		for (const std::string& whole : {plain.str(), colours.str()})
		{
			EXPECT_EQ(load(whole).columns, 148);
			for (size_t length = 0; length < whole.size(); length += 7) expectError([&] { load(whole.substr(0, length)); }, {"damaged"});
			const std::string header = whole.substr(0, whole.find("data\n") + 5);
			expectError([&] { load(header + std::string(3'000'000, '\xFF')); }, {"damaged"});
		}
	}
}

TEST(PlotProgram, SameBytesTwiceAndBadValues)
{
	const ScanRoomFiles files;
	const std::string program = VIWO_BINARY_DIR "/bin/viwo-plot";
	for (const char* extension : {".png", ".svg"})
	{
		const std::string first = files.folder.file(std::string("a") + extension), second = files.folder.file(std::string("b") + extension);
		for (const std::string& path : {first, second}) expectDone(runProgram(program, {"-o", path, "-t", files.tum, "--title", "drive"}));
		EXPECT_FALSE(readFile(first).empty());
		EXPECT_EQ(readFile(first), readFile(second));
		const std::string full = files.folder.file(std::string("full") + extension);
		std::filesystem::create_symlink("/dev/full", full);
		expectRefused(runProgram(program, {"-o", full, "-t", files.tum}), {"/dev/full", "cannot write"});
	}
	for (const char* option : {"--min-z", "--max-z"})
		expectRefused(runProgram(program, {"-o", files.folder.file("c.png"), "-t", files.tum, option, "nan"}), {option});
	expectRefused(runProgram(program, {"-o", files.folder.file("c.png"), "-t", files.tum, "--min-z", "3"}), {"--min-z", "--octomap"});
	expectRefused(runProgram(program, {"-o", files.folder.file("c.png"), "--octomap", "x.bt", "--min-z", "3"}), {"--max-z", "--min-z"});
	writeFile(files.folder.file("far.tum"), "1 0 0 0 0 0 0 1\n2 1e30 0 0 0 0 0 1\n");
	expectRefused(runProgram(program, {"-o", files.folder.file("c.png"), "-t", files.folder.file("far.tum")}), {"far.tum", "1e+30"});
}

TEST(PlotProgram, MapOctoMapLandmarksAndTrajectories)
{
	const ScanRoomFiles files;
	OctoMapRunOptions options;
	options.rawlog = files.rawlog;
	options.trajectory = files.tum;
	options.output = files.folder.file("m.bt");
	options.both = true;
	options.grid = files.folder.file("m.yaml");
	runOctoMap(options);
	writeFile(files.folder.file("l.ply"),
	          "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 1 1\n2 2 2\n");
	const std::string program = VIWO_BINARY_DIR "/bin/viwo-plot";
	const auto plot = [&](std::vector<std::string> arguments)
	{
		arguments.insert(arguments.begin(), {"-o", files.folder.file("p.svg"), "-t", files.tum});
		const ProgramResult result = runProgram(program, arguments);
		EXPECT_EQ(result.status, 0) << result.err;
		EXPECT_EQ(result.err, "");
		return readFile(files.folder.file("p.svg"));
	};
	const std::string of_map = plot({"--map", files.folder.file("m.yaml")});
	EXPECT_EQ(plot({"--octomap", files.folder.file("m.bt")}), of_map) << "the grid is the OctoMap from above";
	EXPECT_EQ(plot({"--octomap", files.folder.file("m.ot")}), of_map);
	EXPECT_NE(plot({"--landmarks", files.folder.file("l.ply")}).find(">landmarks</text>"), std::string::npos);
	const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part)
	{ expectRefused(runProgram(program, arguments), {part}); };
	const std::string out = files.folder.file("q.png");
	refused({"-o", out}, "nothing to draw");
	refused({"-o", out, "--map", files.folder.file("absent.yaml")}, "absent.yaml");
	refused({"-o", out, "--octomap", files.tum}, "not an OctoMap file");
	writeFile(files.folder.file("bad.ot"), "# Octomap OcTree file\nid OcTree\nres 0.1\n");
	refused({"-o", out, "--octomap", files.folder.file("bad.ot")}, "damaged");
	refused({"-o", out, "--octomap", files.folder.file("m.bt"), "--min-z", "7", "--max-z", "8"}, "m.bt");
	refused({"-o", "q.gif", "-t", files.tum}, ".png or .svg");
	EXPECT_FALSE(std::filesystem::exists(out));
}
}  // namespace viwo
