#include <viwo/core/NumberText.h>
#include <viwo/core/Svg.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace viwo
{
namespace
{
/** Bytes of the UTF-8 character that begins at `at`; 0 where there is none, or one that XML 1.0 forbids (names of files may hold any
 * bytes).
 */
size_t characterLength(const std::string& text, size_t at)
{
	const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
	const unsigned first = byte(at);
	if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
	const size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
	if (length == 0) return 0;
	unsigned code = first & (0xFFu >> (length + 1));
	for (size_t i = 1; i < length; ++i)
	{
		if ((byte(at + i) & 0xC0u) != 0x80u) return 0;
		code = code << 6 | (byte(at + i) & 0x3Fu);
	}
	const bool shortest = length == 2 || code >= (length == 3 ? 0x800u : 0x10000u);
	const bool allowed = (code < 0xD800 || code > 0xDFFF) && code != 0xFFFE && code != 0xFFFF && code <= 0x10FFFF;
	return shortest && allowed ? length : 0;
}

bool beginsCharacter(char byte)
{
	return (static_cast<unsigned char>(byte) & 0xC0u) != 0x80u;
}

size_t charactersOf(const std::string& text)
{
	return static_cast<size_t>(std::count_if(text.begin(), text.end(), beginsCharacter));
}

/** Without its middle where it is longer: names of files differ at their ends. */
std::string shortened(const std::string& text, size_t most)
{
	const size_t all = charactersOf(text);
	if (all <= most) return text;
	const std::string mark = "...";
	const size_t head = (most - mark.size()) / 3, tail = all - (most - mark.size() - head);
	std::string first, last;
	size_t at = 0;
	for (const char byte : text)
	{
		at += beginsCharacter(byte) ? 1 : 0;
		if (at <= head) first += byte;
		if (at > tail) last += byte;
	}
	return first + mark + last;
}
}  // namespace

std::string escapedForXml(const std::string& text)
{
	static const std::map<char, const char*> entities{{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
	std::string result;
	for (size_t i = 0; i < text.size();)
	{
		const size_t length = characterLength(text, i);
		if (const auto entity = entities.find(text[i]); entity != entities.end())
			result += entity->second;
		else if (length > 0)
			result.append(text, i, length);
		else
			result += "\xEF\xBF\xBD";  // U+FFFD, the replacement character
		i += std::max<size_t>(length, 1);
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
	const auto most = static_cast<size_t>(std::max(8.0, (width - kColumn - 6) / kCharacter));
	double x = left, y = top;
	svg += "<g font-size=\"13\" fill=\"" + colours.ink + "\">\n";
	for (const SvgLegendEntry& entry : entries)
	{
		const std::string name = shortened(entry.name, most);
		const double needed = kColumn + 22 + kCharacter * static_cast<double>(charactersOf(name));
		if (x > left && x + needed > left + width)
		{
			x = left;
			y += kLine;
		}
		svg += "<g " + entry.style + ">" + svgLine(x, y - 4, x + kColumn, y - 4) + "</g>\n";
		svg += svgText(x + kColumn + 6, y, name);
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
