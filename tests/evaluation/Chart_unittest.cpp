#include <gtest/gtest.h>
#include <viwo/evaluation/Chart.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>

using namespace viwo;

namespace
{
size_t count(const std::string& text, const std::string& part)
{
	size_t n = 0;
	for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
	return n;
}

/** Heights of the bars: rectangles that are filled with a curve's colour. */
std::vector<double> barHeights(const std::string& svg)
{
	std::vector<double> heights;
	const std::regex bar("<rect [^>]*height=\"([0-9.]+)\" fill=\"#(?!ffffff)[0-9a-f]+\"");
	for (std::sregex_iterator it(svg.begin(), svg.end(), bar), end; it != end; ++it) heights.push_back(std::stod((*it)[1]));
	return heights;
}
}  // namespace

TEST(LineChart, BreaksWhereThereIsNoFigure)
{
	LineChart chart{"Errors <m>", "time (s)", "error (m)", {{"a & b", {}}}};
	for (int i = 0; i < 10; ++i) chart.curves[0].points.emplace_back(i, i == 5 ? std::nan("") : 0.1 * i);
	const std::string svg = toSvg(chart);
	EXPECT_EQ(count(svg, "<polyline"), 2u);
	EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
	EXPECT_NE(svg.find("Errors &lt;m&gt;"), std::string::npos);
	EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(LineChart, NothingToShowIsStillAPicture)
{
	for (const LineChart& chart : {LineChart{}, LineChart{"t", "x", "y", {{"empty", {}}}}, LineChart{"t", "x", "y", {{"point", {{1, 1}}}}}})
	{
		const std::string svg = toSvg(chart);
		EXPECT_EQ(svg.find("nan"), std::string::npos);
		EXPECT_EQ(svg.find("inf"), std::string::npos);
		EXPECT_EQ(count(svg, "<svg"), count(svg, "</svg>"));
	}
}

TEST(BarChart, BarsAreAsHighAsTheirFigures)
{
	const BarChart chart{"Times", "time (s)", {"one", "two"}, {{"a", {1, 2}}, {"b", {4, std::nan("")}}}, 2};
	const std::string svg = toSvg(chart);
	const std::vector<double> heights = barHeights(svg);
	ASSERT_EQ(heights.size(), 3u) << "no bar without a figure";
	EXPECT_NEAR(heights[1] / heights[0], 2, 0.02);
	EXPECT_NEAR(heights[2] / heights[0], 4, 0.04);
	EXPECT_NE(svg.find(">4.00<"), std::string::npos);
	EXPECT_NE(svg.find(">-<"), std::string::npos) << "a dash for what is not there";
}

/** Figures over narrow bars beside each other would run into each other. */
TEST(BarChart, FiguresWiderThanTheirBarsAreTurned)
{
	BarChart chart{"Times", "time (s)", {"one", "two"}, {{"a", {1, 2}}, {"b", {4, 3}}}, 3};
	EXPECT_EQ(toSvg(chart).find("rotate(-90)\" font-size"), std::string::npos);
	for (int i = 0; i < 6; ++i) chart.groups.push_back("more");
	for (auto& series : chart.series) series.values.resize(8, 3.5);
	for (int i = 0; i < 2; ++i) chart.series.push_back(chart.series.front());
	const std::string svg = toSvg(chart);
	EXPECT_NE(svg.find("rotate(-90)\" font-size"), std::string::npos);
	// The highest bar leaves room for its figure of five characters.
	const std::vector<double> heights = barHeights(svg);
	EXPECT_LT(*std::max_element(heights.begin(), heights.end()), 220 - 5 * 7);
}

TEST(Charts, TakeTheColoursOfTheirPage)
{
	const BarChart bars{"b", "y", {"g"}, {{"a", {1}}}, 2};
	const LineChart lines{"l", "x", "y", {{"a", {{0, 0}, {1, 1}}}}};
	for (const std::string& svg : {toSvg(bars, PlotColours::page), toSvg(lines, PlotColours::page),
	                               toSvg({{"reference", {{0, 0}, {1, 1}}}}, "p", PlotColours::page)})
	{
		EXPECT_EQ(svg.find('#'), std::string::npos) << "a colour of its own does not change with the page";
		EXPECT_NE(svg.find("var(--ink)"), std::string::npos);
	}
	EXPECT_EQ(toSvg(bars).find("var("), std::string::npos);
}
