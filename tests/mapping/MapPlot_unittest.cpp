#include "ExpectError.h"
#include "RunProgram.h"
#include "ScanRoom.h"

#include <viwo/mapping/MapPlot.h>
#include <viwo/mapping/OctoMapRun.h>
#include <viwo/mapping/OctreeFiles.h>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

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
	{
		const ProgramResult result = runProgram(program, arguments);
		EXPECT_NE(result.status, 0);
		EXPECT_EQ(result.errorLines(), 1u) << result.err;
		EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
	};
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
