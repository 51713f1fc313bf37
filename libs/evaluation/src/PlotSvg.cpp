#include <viwo/core/AtomicFile.h>
#include <viwo/evaluation/PlotSvg.h>
#include <viwo/evaluation/Table.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

namespace viwo
{
namespace
{
// Layout, in user units (pixels at 100 %).
constexpr double kLongSide = 640, kShortestSide = 200;
constexpr double kLeft = 56, kRight = 16, kTop = 36, kAxisHeight = 44, kLegendLine = 20;
constexpr double kLegendColumn = 24, kCharacter = 7.2;
/** Points closer together than this on the paper are one. */
constexpr double kResolution = 0.4;
constexpr int kGridLines = 8;

constexpr const char* kReferenceColour = "#9aa0a6";
/** Okabe and Ito's palette: told apart by the colour-blind, too. */
constexpr std::array<const char*, 6> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

std::string number(double value)
{
	return fixed(value, 1);
}

std::string escaped(const std::string& text)
{
	std::string result;
	for (const char c : text) switch (c)
		{
			case '&':
				result += "&amp;";
				break;
			case '<':
				result += "&lt;";
				break;
			case '>':
				result += "&gt;";
				break;
			case '"':
				result += "&quot;";
				break;
			default:
				result += c;
		}
	return result;
}

/** 1, 2 or 5 times a power of ten: the smallest such step with which `span` needs at most `most` lines. */
double niceStep(double span, int most)
{
	const double least = span / most;
	const double decade = std::pow(10.0, std::floor(std::log10(least)));
	for (const double factor : {1.0, 2.0, 5.0})
		if (factor * decade >= least * (1 - 1e-9)) return factor * decade;
	return 10 * decade;
}

/** Metres as a grid of this step needs them. */
std::string metres(double value, double step)
{
	const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
	return fixed(std::abs(value) < 1e-9 * step ? 0.0 : value, decimals);
}

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

std::string text(double x, double y, const std::string& content, const std::string& attributes = {})
{
	return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\"" + (attributes.empty() ? "" : " " + attributes) + ">" + escaped(content) +
	       "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2)
{
	return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) + "\"/>\n";
}

std::string grid(const Paper& paper)
{
	const double step = paper.step_m();
	const double bottom = kTop + paper.height(), right = kLeft + paper.width();
	std::string lines = "<g stroke=\"#e3e6ea\" stroke-width=\"1\">\n", labels = "<g fill=\"#5f6368\" font-size=\"12\">\n";
	for (double k = std::ceil(paper.low_m().x() / step); k * step <= paper.high_m().x(); k += 1)
	{
		lines += line(paper.x(k * step), kTop, paper.x(k * step), bottom);
		labels += text(paper.x(k * step), bottom + 16, metres(k * step, step), "text-anchor=\"middle\"");
	}
	for (double k = std::ceil(paper.low_m().y() / step); k * step <= paper.high_m().y(); k += 1)
	{
		lines += line(kLeft, paper.y(k * step), right, paper.y(k * step));
		labels += text(kLeft - 6, paper.y(k * step) + 4, metres(k * step, step), "text-anchor=\"end\"");
	}
	labels += text(kLeft + paper.width() / 2, bottom + 34, "x (m)", "text-anchor=\"middle\"");
	labels +=
	    "<text transform=\"translate(14 " + number(kTop + paper.height() / 2) + ") rotate(-90)\" text-anchor=\"middle\">y (m)</text>\n";
	return lines + "</g>\n" + labels + "</g>\n<rect x=\"" + number(kLeft) + "\" y=\"" + number(kTop) + "\" width=\"" +
	       number(paper.width()) + "\" height=\"" + number(paper.height()) + "\" fill=\"none\" stroke=\"#9aa0a6\"/>\n";
}

/** A bar one step of the grid long, in the plot's lower right corner. */
std::string scaleBar(const Paper& paper)
{
	const double length = paper.scale() * paper.step_m();
	const double right = kLeft + paper.width() - 12, y = kTop + paper.height() - 12;
	return "<g stroke=\"#202124\" stroke-width=\"2\">\n" + line(right - length, y, right, y) +
	       line(right - length, y - 4, right - length, y + 4) + line(right, y - 4, right, y + 4) + "</g>\n" +
	       text(right - length / 2, y - 7, metres(paper.step_m(), paper.step_m()) + " m",
	            "text-anchor=\"middle\" fill=\"#202124\" font-size=\"12\"");
}

std::string style(size_t index)
{
	if (index == 0) return std::string("stroke=\"") + kReferenceColour + "\" stroke-width=\"5\"";
	const std::string dashes = (index - 1) / kColours.size() % 2 == 0 ? "" : " stroke-dasharray=\"6 3\"";
	return std::string("stroke=\"") + kColours[(index - 1) % kColours.size()] + "\" stroke-width=\"1.8\"" + dashes;
}

std::string path(const Paper& paper, const PlotCurve& curve, size_t index)
{
	std::string points;
	Eigen::Vector2d last = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
	for (size_t i = 0; i < curve.points_m.size(); ++i)
	{
		const Eigen::Vector2d p(paper.x(curve.points_m[i].x()), paper.y(curve.points_m[i].y()));
		const bool is_last = i + 1 == curve.points_m.size();
		if (!is_last && (p - last).norm() < kResolution) continue;
		points += (points.empty() ? "" : " ") + number(p.x()) + "," + number(p.y());
		last = p;
	}
	if (points.empty()) return {};
	std::string result =
	    "<polyline fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" " + style(index) + " points=\"" + points + "\"/>\n";
	if (index > 0) return result;
	const Eigen::Vector2d start(paper.x(curve.points_m.front().x()), paper.y(curve.points_m.front().y()));
	return result + "<circle cx=\"" + number(start.x()) + "\" cy=\"" + number(start.y()) +
	       "\" r=\"5\" fill=\"#ffffff\" stroke=\"#202124\"/>\n";
}

/** Lines of the legend from `top` on, as many names in a line as go in; returns where it ends. */
double legend(const std::vector<PlotCurve>& curves, double top, double width, std::string& svg)
{
	double x = kLeft, y = top;
	svg += "<g font-size=\"13\" fill=\"#202124\">\n";
	for (size_t i = 0; i < curves.size(); ++i)
	{
		const double needed = kLegendColumn + 22 + kCharacter * static_cast<double>(curves[i].name.size());
		if (x > kLeft && x + needed > kLeft + width)
		{
			x = kLeft;
			y += kLegendLine;
		}
		svg += "<g " + style(i) + ">" + line(x, y - 4, x + kLegendColumn, y - 4) + "</g>\n";
		svg += text(x + kLegendColumn + 6, y, curves[i].name);
		x += needed;
	}
	svg += "</g>\n";
	return y;
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
	if (same_file && folders_tell) return folders;
	return std::set<std::string>(files.begin(), files.end()).size() == paths.size() ? files : paths;
}

std::string toSvg(const std::vector<PlotCurve>& curves, const std::string& title)
{
	const Paper paper(curves);
	std::string body = grid(paper);
	for (size_t i = 0; i < curves.size(); ++i) body += path(paper, curves[i], i);
	body += scaleBar(paper);
	const double legend_end = legend(curves, kTop + paper.height() + kAxisHeight + 14, paper.width(), body);
	const std::string width = number(kLeft + paper.width() + kRight), height = number(legend_end + 14);
	return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height + "\" viewBox=\"0 0 " + width + " " +
	       height + "\" font-family=\"Helvetica, Arial, sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" +
	       text(kLeft, 23, title, "font-size=\"15\" fill=\"#202124\"") + body + "</svg>\n";
}

void saveSvg(const std::string& path, const std::vector<PlotCurve>& curves, const std::string& title)
{
	AtomicFile file(path);
	file.stream() << toSvg(curves, title);
	file.commit();
}
}  // namespace viwo
