#include "AllanPlot.h"

#include <mrpt/core/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "CurveFit.h"

namespace viwo
{
namespace
{
// Layout, in user units (pixels at 100 %).
constexpr double kWidth = 450, kHeight = 330, kLeft = 62, kGap = 84, kRight = 16, kTop = 60, kAxisHeight = 44;
constexpr double kBottom = kTop + kHeight;

/** Figures to places, by their logarithm. */
class LogAxis
{
   public:
	/** Spread to whole decades when `whole`. */
	LogAxis(double low, double high, double from, double to, bool whole) : from_(from), to_(to)
	{
		low_ = std::log10(low);
		high_ = std::log10(high);
		if (whole) low_ = std::floor(low_ + 1e-9), high_ = std::ceil(high_ - 1e-9);
		if (!(high_ > low_)) high_ = low_ + 1;
	}
	double place(double value) const { return from_ + (to_ - from_) * (std::log10(value) - low_) / (high_ - low_); }
	double low() const { return std::pow(10, low_); }
	double high() const { return std::pow(10, high_); }
	std::vector<int> decades() const
	{
		std::vector<int> exponents;
		for (int k = static_cast<int>(std::ceil(low_ - 1e-9)); k <= high_ + 1e-9; ++k) exponents.push_back(k);
		return exponents;
	}

   private:
	double from_, to_, low_ = 0, high_ = 1;
};

std::string superscript(int exponent)
{
	static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
	std::string text = exponent < 0 ? "⁻" : "";
	for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
	return text;
}

std::string decadeText(int exponent)
{
	return "10" + superscript(exponent);
}

std::string threeDigits(double value)
{
	return mrpt::format("%#.3g", value);
}

class Panel
{
   public:
	/** @param first of the three axes. */
	Panel(const ImuNoiseResult& result, size_t first, double left, const SvgPalette& colours)
	    : result_(result),
	      first_(first),
	      left_(left),
	      colours_(colours),
	      x_(range(true).first, range(true).second, left, left + kWidth, false),
	      y_(range(false).first, range(false).second, kBottom, kTop, true)
	{
	}

	std::string draw() const
	{
		std::string svg = grid();
		svg += "<g>\n";
		for (size_t axis = first_; axis < first_ + 3; ++axis) svg += band(axis);
		for (size_t axis = first_; axis < first_ + 3; ++axis) svg += curve(axis);
		svg += "</g>\n" + slopes();
		for (size_t axis = first_; axis < first_ + 3; ++axis) svg += readings(axis);
		return svg + figures();
	}

   private:
	/** Of tau, or of the deviations. */
	std::pair<double, double> range(bool of_tau) const
	{
		double low = std::numeric_limits<double>::infinity(), high = 0;
		for (size_t axis = first_; axis < first_ + 3; ++axis)
			for (const FittedPoint& p : result_.axes[axis].points)
			{
				low = std::min(low, of_tau ? p.point.tau_s : p.low);
				high = std::max(high, of_tau ? p.point.tau_s : p.point.deviation);
			}
		return high > 0 ? std::make_pair(low, high) : std::make_pair(1.0, 10.0);
	}

	const std::string& colour(size_t axis) const { return colours_.curves[axis - first_]; }
	/** Inside of the panel, for lines that go on beyond it. */
	double top(double value) const { return std::clamp(y_.place(value), kTop, kBottom); }

	std::string grid() const
	{
		std::string lines = "<g stroke=\"" + colours_.grid + "\">\n", labels = "<g fill=\"" + colours_.muted + "\" font-size=\"12\">\n";
		for (const int k : y_.decades())
		{
			const double at = y_.place(std::pow(10, k));
			lines += svgLine(left_, at, left_ + kWidth, at);
			labels += svgText(left_ - 6, at + 4, decadeText(k), "text-anchor=\"end\"");
		}
		for (const int k : x_.decades())
		{
			const double at = x_.place(std::pow(10, k));
			lines += svgLine(at, kTop, at, kBottom);
			labels += svgText(at, kBottom + 16, mrpt::format("%g", std::pow(10.0, k)), "text-anchor=\"middle\"");
		}
		labels += svgText(left_ + kWidth / 2, kBottom + 34, "cluster time, s", "text-anchor=\"middle\"");
		labels += svgText(left_, kTop - 10, first_ < 3 ? "accelerometer: Allan deviation, m/s²" : "gyroscope: Allan deviation, rad/s",
		                  "font-size=\"13\"");
		return lines + "</g>\n" + labels + "</g>\n<rect x=\"" + svgNumber(left_) + "\" y=\"" + svgNumber(kTop) + "\" width=\"" +
		       svgNumber(kWidth) + "\" height=\"" + svgNumber(kHeight) + "\" fill=\"none\" stroke=\"" + colours_.reference + "\"/>\n";
	}

	std::string at(double tau_s, double deviation) const { return svgNumber(x_.place(tau_s)) + "," + svgNumber(top(deviation)); }

	std::string band(size_t axis) const
	{
		const auto& points = result_.axes[axis].points;
		std::string text;
		for (auto p = points.begin(); p != points.end(); ++p) text += at(p->point.tau_s, p->high) + " ";
		for (auto p = points.rbegin(); p != points.rend(); ++p) text += at(p->point.tau_s, p->low) + " ";
		return text.empty() ? text : "<polygon fill=\"" + colour(axis) + "\" fill-opacity=\"0.15\" points=\"" + text + "\"/>\n";
	}

	std::string curve(size_t axis) const
	{
		std::string measured, fitted;
		for (const FittedPoint& p : result_.axes[axis].points)
		{
			measured += at(p.point.tau_s, p.point.deviation) + " ";
			if (p.model > 0 && p.point.tau_s >= result_.axes[axis].shortest_s) fitted += at(p.point.tau_s, p.model) + " ";
		}
		const std::string line = "<polyline fill=\"none\" stroke-linejoin=\"round\" ";
		return line + svgCurveStyle(axis - first_, colours_) + " points=\"" + measured + "\"/>\n" + line + "stroke=\"" + colours_.ink +
		       "\" stroke-width=\"1\" stroke-dasharray=\"4 3\" points=\"" + fitted + "\"/>\n";
	}

	const WorstAxis& noise() const { return first_ < 3 ? result_.acc_noise : result_.gyro_noise; }
	const WorstAxis& walk() const { return first_ < 3 ? result_.acc_walk : result_.gyro_walk; }

	/** A straight line in the panel. @param at_1s its deviation there. */
	std::string slope(double at_1s, double exponent) const
	{
		// Where it leaves through top or bottom, by its logarithm.
		const double a = std::pow(y_.low() / at_1s, 1 / exponent), b = std::pow(y_.high() / at_1s, 1 / exponent);
		const double begin_s = std::max(x_.low(), std::min(a, b)), end_s = std::min(x_.high(), std::max(a, b));
		if (!(end_s > begin_s)) return {};
		return svgLine(x_.place(begin_s), y_.place(at_1s * std::pow(begin_s, exponent)), x_.place(end_s),
		               y_.place(at_1s * std::pow(end_s, exponent)));
	}

	/** Of the worst axes. */
	std::string slopes() const
	{
		std::string lines = "<g stroke=\"" + colours_.muted + "\" stroke-width=\"1\" stroke-dasharray=\"1 3\">\n";
		if (noise().reading.observed) lines += slope(noise().reading.value, -0.5);
		if (walk().reading.observed) lines += slope(walk().reading.value / std::sqrt(3.0), 0.5);
		return lines + "</g>\n";
	}

	std::string mark(size_t axis, double tau_s, double deviation, bool filled) const
	{
		if (tau_s < x_.low() || tau_s > x_.high() || deviation < y_.low() || deviation > y_.high()) return {};
		return "<circle cx=\"" + svgNumber(x_.place(tau_s)) + "\" cy=\"" + svgNumber(y_.place(deviation)) +
		       "\" r=\"4\" stroke-width=\"1.5\" stroke=\"" + colour(axis) + "\" fill=\"" + (filled ? colour(axis) : colours_.background) +
		       "\"/>\n";
	}

	/** N at 1 s and K at 3 s filled, the least hollow. */
	std::string readings(size_t axis) const
	{
		const NoiseModel& m = result_.axes[axis];
		std::string marks;
		if (m.instability.reached) marks += mark(axis, m.instability.tau_s, m.instability.value * kFlatPart, false);
		if (m.white.observed) marks += mark(axis, 1, m.white.value, true);
		if (m.walk.observed) marks += mark(axis, 3, m.walk.value, true);
		return marks;
	}

	std::string axisLetter(size_t axis) const { return std::string(" (") + "xyz"[axis - first_] + ")"; }

	/** In the corner above the falling curves: the worst axes. */
	std::string figures() const
	{
		const std::string unit = first_ < 3 ? "m/s²" : "rad/s", walk_unit = first_ < 3 ? " m/s³/√Hz" : " rad/s²/√Hz";
		std::vector<std::string> lines;
		if (noise().reading.observed)
			lines.push_back("N = " + threeDigits(noise().reading.value) + " " + unit + "/√Hz" + axisLetter(noise().axis));
		size_t worst = first_;
		for (size_t axis = first_; axis < first_ + 3; ++axis)
			if (result_.axes[axis].instability.value > result_.axes[worst].instability.value) worst = axis;
		const BiasInstability& b = result_.axes[worst].instability;
		if (b.value > 0) lines.push_back((b.reached ? "B = " : "B < ") + threeDigits(b.value) + " " + unit + axisLetter(worst));
		lines.push_back(walk().reading.observed ? "K = " + threeDigits(walk().reading.value) + walk_unit + axisLetter(walk().axis)
		                                        : "K not observed, below " + threeDigits(walk().reading.limit) + walk_unit);
		std::string svg = "<g font-size=\"12\" fill=\"" + colours_.ink + "\">\n";
		for (size_t i = 0; i < lines.size(); ++i)
			svg += svgText(left_ + kWidth - 10, kTop + 20 + 17 * static_cast<double>(i), lines[i], "text-anchor=\"end\"");
		return svg + "</g>\n";
	}

	const ImuNoiseResult& result_;
	size_t first_;
	double left_;
	const SvgPalette& colours_;
	LogAxis x_, y_;
};
}  // namespace

std::string allanPlot(const ImuNoiseResult& result, const std::vector<size_t>& sensors, const SvgPalette& colours)
{
	std::string body;
	double width = 0;
	for (const size_t first : sensors)
	{
		if (width > 0) width += kGap;
		body += Panel(result, first, kLeft + width, colours).draw();
		width += kWidth;
	}
	std::vector<SvgLegendEntry> entries;
	for (size_t k = 0; k < 3; ++k) entries.push_back({std::string(1, "xyz"[k]), svgCurveStyle(k, colours)});
	entries.push_back({"fit", "stroke=\"" + colours.ink + "\" stroke-width=\"1\" stroke-dasharray=\"4 3\""});
	entries.push_back(
	    {"slopes -1/2 and +1/2 of the worst axis", "stroke=\"" + colours.muted + "\" stroke-width=\"1\" stroke-dasharray=\"1 3\""});
	double end = svgLegend(entries, kLeft, kBottom + kAxisHeight + 18, width, colours, body);
	if (sensors.size() > 1)
	{
		end += 20;
		body += svgText(kLeft, end, kAllanMarks, "font-size=\"12\" fill=\"" + colours.muted + "\"");
	}
	return svgPicture(kLeft + width + kRight, end + 14, "Allan deviation of " + result.imu_label + " at rest", kLeft, colours, body);
}
}  // namespace viwo
