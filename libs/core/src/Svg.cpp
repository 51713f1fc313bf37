#include <viwo/core/NumberText.h>
#include <viwo/core/Svg.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
std::string escapedForXml(const std::string& text)
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

std::string svgNumber(double value)
{
	return fixed(value, 1);
}

double niceStep(double span, int most)
{
	const double least = span / most;
	const double decade = std::pow(10.0, std::floor(std::log10(least)));
	for (const double factor : {1.0, 2.0, 5.0})
		if (factor * decade >= least * (1 - 1e-9)) return factor * decade;
	return 10 * decade;
}

std::string onGrid(double value, double step)
{
	const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
	return fixed(std::abs(value) < 1e-9 * step ? 0.0 : value, decimals);
}

const SvgPalette& lightPalette()
{
	static const SvgPalette palette{"#ffffff", "#202124", "#5f6368",
	                                "#e3e6ea", "#9aa0a6", {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"}};
	return palette;
}

const SvgPalette& pagePalette()
{
	static const SvgPalette palette{"var(--paper)",     "var(--ink)",
	                                "var(--muted)",     "var(--grid)",
	                                "var(--reference)", {"var(--c1)", "var(--c2)", "var(--c3)", "var(--c4)", "var(--c5)", "var(--c6)"}};
	return palette;
}

std::string svgText(double x, double y, const std::string& content, const std::string& attributes)
{
	return "<text x=\"" + svgNumber(x) + "\" y=\"" + svgNumber(y) + "\"" + (attributes.empty() ? "" : " " + attributes) + ">" +
	       escapedForXml(content) + "</text>\n";
}

std::string svgLine(double x1, double y1, double x2, double y2)
{
	return "<line x1=\"" + svgNumber(x1) + "\" y1=\"" + svgNumber(y1) + "\" x2=\"" + svgNumber(x2) + "\" y2=\"" + svgNumber(y2) + "\"/>\n";
}

std::string svgCurveStyle(size_t index, const SvgPalette& colours)
{
	const std::string dashes = index / colours.curves.size() % 2 == 0 ? "" : " stroke-dasharray=\"6 3\"";
	return "stroke=\"" + colours.curves[index % colours.curves.size()] + "\" stroke-width=\"1.8\"" + dashes;
}

double svgLegend(const std::vector<SvgLegendEntry>& entries, double left, double top, double width, const SvgPalette& colours,
                 std::string& svg)
{
	constexpr double kLine = 20, kColumn = 24, kCharacter = 7.2;
	double x = left, y = top;
	svg += "<g font-size=\"13\" fill=\"" + colours.ink + "\">\n";
	for (const SvgLegendEntry& entry : entries)
	{
		const double needed = kColumn + 22 + kCharacter * static_cast<double>(entry.name.size());
		if (x > left && x + needed > left + width)
		{
			x = left;
			y += kLine;
		}
		svg += "<g " + entry.style + ">" + svgLine(x, y - 4, x + kColumn, y - 4) + "</g>\n";
		svg += svgText(x + kColumn + 6, y, entry.name);
		x += needed;
	}
	svg += "</g>\n";
	return y;
}

std::string svgPicture(double width, double height, const std::string& title, double title_x, const SvgPalette& colours,
                       const std::string& body)
{
	const std::string w = svgNumber(width), h = svgNumber(height);
	return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h + "\" viewBox=\"0 0 " + w + " " + h +
	       "\" font-family=\"Helvetica, Arial, sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"" + colours.background +
	       "\"/>\n" + svgText(title_x, 23, title, "font-size=\"15\" fill=\"" + colours.ink + "\"") + body + "</svg>\n";
}
}  // namespace viwo
