#include "RandomTrajectory.h"

#include <viwo/evaluation/PlotSvg.h>

#include <gtest/gtest.h>

#include <regex>

using namespace viwo;
using namespace viwo::testing;

namespace
{
/** Pixel coordinates of the polylines, in the order of the curves. */
std::vector<std::vector<Eigen::Vector2d>> polylines(const std::string& svg)
{
	std::vector<std::vector<Eigen::Vector2d>> lines;
	const std::regex polyline("<polyline[^>]*points=\"([^\"]*)\""), pair("(-?[0-9.]+),(-?[0-9.]+)");
	for (std::sregex_iterator it(svg.begin(), svg.end(), polyline), end; it != end; ++it)
	{
		const std::string points = (*it)[1];
		lines.emplace_back();
		for (std::sregex_iterator p(points.begin(), points.end(), pair); p != end; ++p)
			lines.back().emplace_back(std::stod((*p)[1]), std::stod((*p)[2]));
	}
	return lines;
}

PlotCurve circle(const std::string& name, double radius_m, const Eigen::Vector2d& centre_m)
{
	PlotCurve curve{name, {}};
	for (int i = 0; i <= 360; ++i)
		curve.points_m.push_back(centre_m + radius_m * Eigen::Vector2d(std::cos(i * M_PI / 180), std::sin(i * M_PI / 180)));
	return curve;
}
}  // namespace

/** A circle stays one, y points up, and all is inside of the picture, whatever the size of the scene. */
TEST(PlotSvg, AxesAreEqualAtEveryScale)
{
	for (const double radius_m : {1e-3, 0.7, 40.0, 3e4})
	{
		const Eigen::Vector2d centre_m(1e3 * radius_m, -5 * radius_m);
		const auto lines = polylines(toSvg({circle("truth", radius_m, centre_m), circle("estimate", 0.5 * radius_m, centre_m)}, "circles"));
		ASSERT_EQ(lines.size(), 2u);
		Eigen::Vector2d low = lines[0][0], high = lines[0][0];
		for (const auto& line : lines)
			for (const Eigen::Vector2d& p : line)
			{
				low = low.cwiseMin(p);
				high = high.cwiseMax(p);
			}
		EXPECT_NEAR(high.x() - low.x(), high.y() - low.y(), 0.5) << radius_m;
		EXPECT_GT(high.x() - low.x(), 180);
		EXPECT_GT(low.minCoeff(), 0);
		const Eigen::Vector2d centre = 0.5 * (low + high);
		EXPECT_NEAR((lines[1][0] - centre).norm(), 0.25 * (high.x() - low.x()), 0.5);
		EXPECT_LT(lines[0][lines[0].size() / 4].y(), centre.y()) << "up is towards smaller pixel rows";
	}
}

TEST(PlotSvg, ScaleBarIsAsLongAsItSays)
{
	const std::string svg = toSvg({circle("truth", 2, Eigen::Vector2d::Zero())}, "t");
	const auto line = polylines(svg).at(0);
	const double pixels_per_metre = (line[0] - line[line.size() / 2]).norm() / 4;
	std::smatch bar;
	const std::regex pattern(
	    "<line x1=\"([0-9.]+)\" y1=\"([0-9.]+)\" x2=\"([0-9.]+)\" y2=\"\\2\"/>\n<line[^\n]*\n<line[^\n]*\n</g>\n<text[^>]*>([0-9.]+) m<");
	ASSERT_TRUE(std::regex_search(svg, bar, pattern));
	EXPECT_NEAR((std::stod(bar[3]) - std::stod(bar[1])) / pixels_per_metre, std::stod(bar[4]), 0.02);
}

TEST(PlotSvg, SameCurvesGiveTheSameBytesAndNamesAreEscaped)
{
	const std::vector<PlotCurve> curves{plotCurve("a<b & \"c\"", windingDrive(50, 20)), circle("estimate", 1, {0, 0})};
	const std::string svg = toSvg(curves, "x > y");
	EXPECT_EQ(svg, toSvg(curves, "x > y"));
	EXPECT_NE(svg.find("a&lt;b &amp; &quot;c&quot;"), std::string::npos);
	EXPECT_EQ(svg.find("a<b"), std::string::npos);
	EXPECT_NE(svg.find("x &gt; y"), std::string::npos);
}

TEST(PlotSvg, EmptyAndStandingCurvesAreNoProblem)
{
	EXPECT_TRUE(polylines(toSvg({{"nothing", {}}}, "t")).empty());
	const auto standing = polylines(toSvg({{"standing", {{3, 4}, {3, 4}}}}, "t"));
	ASSERT_EQ(standing.size(), 1u);
	EXPECT_TRUE(standing[0][0].allFinite());
}

TEST(PlotSvg, LegendNamesTellFilesApart)
{
	using Names = std::vector<std::string>;
	EXPECT_EQ(legendNames({"out/wheel/trajectory.tum", "out/vio/trajectory.tum"}), (Names{"wheel", "vio"}));
	EXPECT_EQ(legendNames({"out/trajectory.tum"}), (Names{"out"}));
	EXPECT_EQ(legendNames({"rawlogs/sample_ground_truth.tum"}), (Names{"sample_ground_truth"}));
	EXPECT_EQ(legendNames({"a.tum", "b.tum"}), (Names{"a", "b"}));
	EXPECT_EQ(legendNames({"x/a.tum", "x/a.tum"}), (Names{"x/a.tum", "x/a.tum"}));
}

/** Northings have seven figures: they are neither cut off nor run into the name of the axis. */
TEST(PlotSvg, LongFiguresHaveTheirRoom)
{
	const std::string near = toSvg({circle("truth", 30, {0, 0})}, "near"), far = toSvg({circle("truth", 30, {5e5, 4.6e6})}, "far");
	EXPECT_NE(far.find(">4600000<"), std::string::npos);
	EXPECT_NE(far.find("<g transform=\"translate(24.9 0)\">"), std::string::npos);
	EXPECT_NE(far.find("translate(-10.9 "), std::string::npos) << "the name of the axis stays at the edge";
	EXPECT_EQ(near.find("<g transform"), std::string::npos);
}

TEST(PlotSvg, LongNamesLoseTheirMiddle)
{
	const std::string name = "run_\xC3\xBC_" + std::string(100, 'x') + "_the_end (ATE 0.123 m)";
	const std::string svg = toSvg({circle("truth", 1, {0, 0}), circle(name, 1, {0, 0})}, "names");
	EXPECT_EQ(svg.find(name), std::string::npos);
	const size_t begin = svg.find(">run_\xC3\xBC_x"), end = svg.find("x_the_end (ATE 0.123 m)<");
	ASSERT_NE(begin, std::string::npos);
	ASSERT_NE(end, std::string::npos);
	EXPECT_LT(end - begin, 64u) << "as many characters as the picture is wide";
}
