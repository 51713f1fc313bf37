#include <viwo/core/Svg.h>
#include <viwo/evaluation/Chart.h>
#include <viwo/evaluation/Table.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "Margin.h"

namespace viwo
{
namespace
{
// Layout, in user units (pixels at 100 %).
constexpr double kWidth = 480, kHeight = 220, kLeft = 56, kRight = 16, kTop = 36, kAxisHeight = 44;
constexpr double kBottom = kTop + kHeight;
constexpr int kGridLinesX = 8, kGridLinesY = 6;
/** Figures over bars: their size, and how wide a character is at most. */
constexpr double kFigure = 11, kFigureCharacter = 7;

/** One axis: figures to places. */
class Axis
{
   public:
	/** @param from, to places of low and high. */
	Axis(double low, double high, double from, double to, int lines) : from_(from), to_(to)
	{
		if (!(high > low)) high = low + 1;
		step_ = niceStep(high - low, lines);
		low_ = low;
		high_ = high;
	}
	double place(double value) const { return from_ + (to_ - from_) * (value - low_) / (high_ - low_); }
	double step() const { return step_; }
	std::vector<double> ticks() const
	{
		std::vector<double> values;
		for (double k = std::ceil(low_ / step_ - 1e-9); k * step_ <= high_ * (1 + 1e-9); k += 1) values.push_back(k * step_);
		return values;
	}

   private:
	double low_ = 0, high_ = 1, from_, to_, step_ = 1;
};

std::string yGrid(const Axis& y, const std::string& label, const SvgPalette& c, Margin& margin)
{
	std::string lines = "<g stroke=\"" + c.grid + "\">\n", labels = "<g fill=\"" + c.muted + "\" font-size=\"12\">\n";
	for (const double value : y.ticks())
	{
		lines += svgLine(kLeft, y.place(value), kLeft + kWidth, y.place(value));
		const std::string figure = onGrid(value, y.step());
		margin.add(figure);
		labels += svgText(kLeft - 6, y.place(value) + 4, figure, "text-anchor=\"end\"");
	}
	labels += "<text transform=\"translate(" + svgNumber(14 - margin.missing()) + " " + svgNumber(kTop + kHeight / 2) +
	          ") rotate(-90)\" text-anchor=\"middle\">" + escapedForXml(label) + "</text>\n";
	return lines + "</g>\n" + labels + "</g>\n";
}

std::string xGrid(const Axis& x, const std::string& label, const SvgPalette& c)
{
	std::string lines = "<g stroke=\"" + c.grid + "\">\n", labels = "<g fill=\"" + c.muted + "\" font-size=\"12\">\n";
	for (const double value : x.ticks())
	{
		lines += svgLine(x.place(value), kTop, x.place(value), kBottom);
		labels += svgText(x.place(value), kBottom + 16, onGrid(value, x.step()), "text-anchor=\"middle\"");
	}
	labels += svgText(kLeft + kWidth / 2, kBottom + 34, label, "text-anchor=\"middle\"");
	return lines + "</g>\n" + labels + "</g>\n";
}

std::string frame(const SvgPalette& c)
{
	return "<rect x=\"" + svgNumber(kLeft) + "\" y=\"" + svgNumber(kTop) + "\" width=\"" + svgNumber(kWidth) + "\" height=\"" +
	       svgNumber(kHeight) + "\" fill=\"none\" stroke=\"" + c.reference + "\"/>\n";
}

/** Pieces between NaNs; of points that fall on one column, the first and the extremes would look the same: those half a pixel on are kept.
 */
std::string curve(const LineChart::Curve& curve, const Axis& x, const Axis& y, const std::string& style)
{
	std::string svg, points;
	double last_x = -std::numeric_limits<double>::infinity();
	const auto flush = [&]
	{
		if (!points.empty()) svg += "<polyline fill=\"none\" stroke-linejoin=\"round\" " + style + " points=\"" + points + "\"/>\n";
		points.clear();
	};
	for (const Eigen::Vector2d& p : curve.points)
	{
		if (!p.allFinite())
		{
			flush();
			continue;
		}
		const double px = x.place(p.x());
		if (px - last_x < 0.5 && !points.empty()) continue;
		points += (points.empty() ? "" : " ") + svgNumber(px) + "," + svgNumber(y.place(p.y()));
		last_x = px;
	}
	flush();
	return svg;
}

std::string textOf(double value, int decimals)
{
	return std::isfinite(value) ? fixed(value, decimals) : "-";
}

/** The width of the longest figure over a bar. */
double widestFigure(const BarChart& chart)
{
	size_t characters = 1;
	for (const auto& series : chart.series)
		for (const double value : series.values) characters = std::max(characters, textOf(value, chart.decimals).size());
	return kFigureCharacter * static_cast<double>(characters);
}

/** Of the letters below the groups: their names stay apart. */
double groupSize(const BarChart& chart, double group_width)
{
	constexpr double kMost = 12, kLeast = 7, kWidthOfSize = 0.62;
	size_t characters = 1;
	for (const std::string& group : chart.groups) characters = std::max(characters, group.size());
	return std::clamp(0.95 * group_width / (kWidthOfSize * static_cast<double>(characters)), kLeast, kMost);
}

/** @param upright the figure is turned by a quarter: bars beside each other are narrower than their figures. */
std::string bar(double x, double width, double top, const std::string& figure, bool upright, const std::string& fill, const SvgPalette& c)
{
	const double middle = x + width / 2;
	const double size = upright ? std::min(kFigure, width) : kFigure;
	const std::string style = "font-size=\"" + svgNumber(size) + "\" fill=\"" + c.muted + "\"";
	const std::string rect = "<rect x=\"" + svgNumber(x) + "\" y=\"" + svgNumber(top) + "\" width=\"" + svgNumber(width) + "\" height=\"" +
	                         svgNumber(kBottom - top) + "\" fill=\"" + fill + "\"/>\n";
	const std::string text = upright ? "<text transform=\"translate(" + svgNumber(middle + 0.35 * size) + " " + svgNumber(top - 4) +
	                                       ") rotate(-90)\" " + style + ">" + figure + "</text>\n"
	                                 : svgText(middle, top - 4, figure, "text-anchor=\"middle\" " + style);
	return (top < kBottom ? rect : "") + text;
}
}  // namespace

std::string toSvg(const LineChart& chart, PlotColours colours)
{
	const SvgPalette& c = colours == PlotColours::page ? pagePalette() : lightPalette();
	double left = std::numeric_limits<double>::infinity(), right = -left, low = 0, high = 0;
	for (const auto& curve : chart.curves)
		for (const Eigen::Vector2d& p : curve.points)
		{
			if (!p.allFinite()) continue;
			left = std::min(left, p.x());
			right = std::max(right, p.x());
			low = std::min(low, p.y());
			high = std::max(high, p.y());
		}
	if (!(right >= left)) left = right = 0;
	const double room = 0.05 * (high - low);
	const Axis x(left, right, kLeft, kLeft + kWidth, kGridLinesX), y(low < 0 ? low - room : 0, high + room, kBottom, kTop, kGridLinesY);
	Margin margin;
	std::string body = xGrid(x, chart.x_label, c) + yGrid(y, chart.y_label, c, margin) + frame(c);
	std::vector<SvgLegendEntry> entries;
	for (size_t i = 0; i < chart.curves.size(); ++i)
	{
		entries.push_back({chart.curves[i].name, svgCurveStyle(i, c)});
		body += curve(chart.curves[i], x, y, entries.back().style);
	}
	const double end = svgLegend(entries, kLeft, kBottom + kAxisHeight + 14, kWidth, c, body);
	return svgPicture(kLeft + kWidth + kRight + margin.missing(), end + 14, chart.title, kLeft + margin.missing(), c, margin.moved(body));
}

std::string toSvg(const BarChart& chart, PlotColours colours)
{
	const SvgPalette& c = colours == PlotColours::page ? pagePalette() : lightPalette();
	double high = 0;
	for (const auto& series : chart.series)
		for (const double value : series.values)
			if (std::isfinite(value)) high = std::max(high, value);
	const double group_width = kWidth / static_cast<double>(std::max<size_t>(1, chart.groups.size()));
	const double width = 0.86 * group_width / static_cast<double>(std::max<size_t>(1, chart.series.size()));
	const bool upright = widestFigure(chart) > width;
	const double room = upright ? widestFigure(chart) + 8 : kFigure + 8;
	const Axis y(0, high * kHeight / (kHeight - room), kBottom, kTop, kGridLinesY);
	Margin margin;
	std::string body = yGrid(y, chart.y_label, c, margin) + frame(c);
	std::vector<SvgLegendEntry> entries;
	for (size_t s = 0; s < chart.series.size(); ++s)
	{
		const auto& series = chart.series[s];
		const std::string& fill = c.curves[series.colour.value_or(s) % c.curves.size()];
		entries.push_back({series.name, "stroke=\"" + fill + "\" stroke-width=\"8\""});
		for (size_t g = 0; g < chart.groups.size() && g < series.values.size(); ++g)
		{
			const double x = kLeft + (static_cast<double>(g) + 0.07) * group_width + static_cast<double>(s) * width;
			const double value = series.values[g];
			body += bar(x, 0.92 * width, std::isfinite(value) ? y.place(value) : kBottom, textOf(value, chart.decimals), upright, fill, c);
		}
	}
	const std::string group_style =
	    "text-anchor=\"middle\" font-size=\"" + svgNumber(groupSize(chart, group_width)) + "\" fill=\"" + c.muted + "\"";
	for (size_t g = 0; g < chart.groups.size(); ++g)
		body += svgText(kLeft + (static_cast<double>(g) + 0.5) * group_width, kBottom + 18, chart.groups[g], group_style);
	const double end = svgLegend(entries, kLeft, kBottom + kAxisHeight + 4, kWidth, c, body);
	return svgPicture(kLeft + kWidth + kRight + margin.missing(), end + 14, chart.title, kLeft + margin.missing(), c, margin.moved(body));
}
}  // namespace viwo
