#pragma once

#include <viwo/evaluation/PlotSvg.h>

#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** One figure against another, e.g. an error over time. NaN breaks a curve. */
struct LineChart
{
	struct Curve
	{
		std::string name;
		std::vector<Eigen::Vector2d> points;  //!< x rising
	};
	std::string title, x_label, y_label;  //!< labels with their units
	std::vector<Curve> curves;
};

/** Groups of bars beside each other, zero at the bottom. NaN: no bar, a dash. */
struct BarChart
{
	struct Series
	{
		std::string name;
		std::vector<double> values = {};    //!< one for each group
		std::optional<size_t> colour = {};  //!< of the palette, so that charts side by side agree; its place in the list without it
	};
	std::string title, y_label;
	std::vector<std::string> groups;
	std::vector<Series> series;
	int decimals = 2;  //!< of the figures over the bars
};

/** Plain SVG 1.1; the same figures give the same bytes. */
std::string toSvg(const LineChart& chart, PlotColours colours = PlotColours::light);
std::string toSvg(const BarChart& chart, PlotColours colours = PlotColours::light);
}  // namespace viwo
