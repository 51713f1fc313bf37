#include <viwo/core/AtomicFile.h>
#include <viwo/core/Svg.h>
#include <viwo/evaluation/PlotSvg.h>
#include <viwo/evaluation/Table.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "Margin.h"

namespace viwo
{
namespace
{
// Layout, in user units (pixels at 100 %).
constexpr double kLongSide = 480, kShortestSide = 180;
constexpr double kLeft = 56, kRight = 16, kTop = 36, kAxisHeight = 44;
/** Points closer together than this on the paper are one. */
constexpr double kResolution = 0.4;
constexpr int kGridLines = 8;

/** Where metres fall on the paper. */
class Paper
{
   public:
	explicit Paper(const std::vector<PlotCurve>& curves)
	{
		Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
		for (const PlotCurve& curve : curves)
			for (const Eigen::Vector2d& p : curve.points_m)
			{
				low = low.cwiseMin(p);
				high = high.cwiseMax(p);
			}
		if (!low.allFinite() || !high.allFinite()) low = high = Eigen::Vector2d::Zero();
		const double extent = std::max({high.x() - low.x(), high.y() - low.y(), 0.01});
		const double shortest = extent * kShortestSide / kLongSide;
		const Eigen::Vector2d middle = 0.5 * (low + high);
		const Eigen::Vector2d half = (0.5 * (high - low)).cwiseMax(0.5 * shortest) + Eigen::Vector2d::Constant(0.06 * extent);
		low_m_ = middle - half;
		high_m_ = middle + half;
		scale_ = kLongSide / (2 * half.maxCoeff());
		step_m_ = niceStep(2 * half.maxCoeff(), kGridLines);
	}

	double width() const { return scale_ * (high_m_.x() - low_m_.x()); }
	double height() const { return scale_ * (high_m_.y() - low_m_.y()); }
	double x(double x_m) const { return kLeft + scale_ * (x_m - low_m_.x()); }
	double y(double y_m) const { return kTop + scale_ * (high_m_.y() - y_m); }
	double scale() const { return scale_; }
	double step_m() const { return step_m_; }
	const Eigen::Vector2d& low_m() const { return low_m_; }
	const Eigen::Vector2d& high_m() const { return high_m_; }

   private:
	Eigen::Vector2d low_m_, high_m_;
	double scale_ = 1, step_m_ = 1;
};

std::string grid(const Paper& paper, const SvgPalette& c, Margin& margin)
{
	const double step = paper.step_m();
	const double bottom = kTop + paper.height(), right = kLeft + paper.width();
	std::string lines = "<g stroke=\"" + c.grid + "\" stroke-width=\"1\">\n", labels = "<g fill=\"" + c.muted + "\" font-size=\"12\">\n";
	for (double k = std::ceil(paper.low_m().x() / step); k * step <= paper.high_m().x(); k += 1)
	{
		lines += svgLine(paper.x(k * step), kTop, paper.x(k * step), bottom);
		labels += svgText(paper.x(k * step), bottom + 16, onGrid(k * step, step), "text-anchor=\"middle\"");
	}
	for (double k = std::ceil(paper.low_m().y() / step); k * step <= paper.high_m().y(); k += 1)
	{
		lines += svgLine(kLeft, paper.y(k * step), right, paper.y(k * step));
		const std::string figure = onGrid(k * step, step);
		margin.add(figure);
		labels += svgText(kLeft - 6, paper.y(k * step) + 4, figure, "text-anchor=\"end\"");
	}
	labels += svgText(kLeft + paper.width() / 2, bottom + 34, "x (m)", "text-anchor=\"middle\"");
	labels += "<text transform=\"translate(" + svgNumber(14 - margin.missing()) + " " + svgNumber(kTop + paper.height() / 2) +
	          ") rotate(-90)\" text-anchor=\"middle\">y (m)</text>\n";
	return lines + "</g>\n" + labels + "</g>\n<rect x=\"" + svgNumber(kLeft) + "\" y=\"" + svgNumber(kTop) + "\" width=\"" +
	       svgNumber(paper.width()) + "\" height=\"" + svgNumber(paper.height()) + "\" fill=\"none\" stroke=\"" + c.reference + "\"/>\n";
}

/** A bar one step of the grid long, in the plot's lower right corner. */
std::string scaleBar(const Paper& paper, const SvgPalette& c)
{
	const double length = paper.scale() * paper.step_m();
	const double right = kLeft + paper.width() - 12, y = kTop + paper.height() - 12;
	return "<g stroke=\"" + c.ink + "\" stroke-width=\"2\">\n" + svgLine(right - length, y, right, y) +
	       svgLine(right - length, y - 4, right - length, y + 4) + svgLine(right, y - 4, right, y + 4) + "</g>\n" +
	       svgText(right - length / 2, y - 7, onGrid(paper.step_m(), paper.step_m()) + " m",
	               "text-anchor=\"middle\" fill=\"" + c.ink + "\" font-size=\"12\"");
}

std::string style(size_t index, const SvgPalette& c)
{
	return index == 0 ? "stroke=\"" + c.reference + "\" stroke-width=\"5\"" : svgCurveStyle(index - 1, c);
}

std::string path(const Paper& paper, const PlotCurve& curve, size_t index, const SvgPalette& c)
{
	std::string points;
	Eigen::Vector2d last = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
	for (size_t i = 0; i < curve.points_m.size(); ++i)
	{
		const Eigen::Vector2d p(paper.x(curve.points_m[i].x()), paper.y(curve.points_m[i].y()));
		const bool is_last = i + 1 == curve.points_m.size();
		if (!is_last && (p - last).norm() < kResolution) continue;
		points += (points.empty() ? "" : " ") + svgNumber(p.x()) + "," + svgNumber(p.y());
		last = p;
	}
	if (points.empty()) return {};
	std::string result =
	    "<polyline fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" " + style(index, c) + " points=\"" + points + "\"/>\n";
	if (index > 0) return result;
	const Eigen::Vector2d start(paper.x(curve.points_m.front().x()), paper.y(curve.points_m.front().y()));
	return result + "<circle cx=\"" + svgNumber(start.x()) + "\" cy=\"" + svgNumber(start.y()) + "\" r=\"5\" fill=\"" + c.background +
	       "\" stroke=\"" + c.ink + "\"/>\n";
}
}  // namespace

PlotCurve plotCurve(const std::string& name, const Trajectory& reference)
{
	PlotCurve curve{name, {}};
	for (const StampedPose& pose : reference.poses()) curve.points_m.emplace_back(pose.T.p.head<2>());
	return curve;
}

PlotCurve plotCurve(const std::string& name, const std::vector<MatchedPose>& matches)
{
	PlotCurve curve{name, {}};
	for (const MatchedPose& match : matches) curve.points_m.emplace_back(match.T_est.p.head<2>());
	return curve;
}

std::vector<std::string> legendNames(const std::vector<std::string>& paths)
{
	std::vector<std::string> folders, files;
	for (const std::string& path : paths)
	{
		const std::filesystem::path p(path);
		files.push_back(p.stem().string());
		folders.push_back(p.parent_path().filename().string());
	}
	const bool folders_tell =
	    std::set<std::string>(folders.begin(), folders.end()).size() == paths.size() && std::count(folders.begin(), folders.end(), "") == 0;
	const bool same_file = std::set<std::string>(files.begin(), files.end()).size() == 1;
	// A path alone is told by its file, unless that has the name that all runs give it.
	if (same_file && folders_tell && (paths.size() > 1 || files.front() == "trajectory")) return folders;
	return std::set<std::string>(files.begin(), files.end()).size() == paths.size() ? files : paths;
}

std::string toSvg(const std::vector<PlotCurve>& curves, const std::string& title, PlotColours colours)
{
	const SvgPalette& c = colours == PlotColours::page ? pagePalette() : lightPalette();
	const Paper paper(curves);
	Margin margin;
	std::string body = grid(paper, c, margin);
	for (size_t i = 0; i < curves.size(); ++i) body += path(paper, curves[i], i, c);
	body += scaleBar(paper, c);
	std::vector<SvgLegendEntry> entries;
	for (size_t i = 0; i < curves.size(); ++i) entries.push_back({curves[i].name, style(i, c)});
	const double legend_end = svgLegend(entries, kLeft, kTop + paper.height() + kAxisHeight + 14, paper.width(), c, body);
	return svgPicture(kLeft + paper.width() + kRight + margin.missing(), legend_end + 14, title, kLeft + margin.missing(), c,
	                  margin.moved(body));
}

void saveSvg(const std::string& path, const std::vector<PlotCurve>& curves, const std::string& title)
{
	writeAtomically(path, toSvg(curves, title));
}
}  // namespace viwo
