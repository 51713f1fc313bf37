#pragma once

#include <string>
#include <vector>

/** Parts of which pictures are made. @file */
namespace viwo
{
/** Text for XML and HTML. */
std::string escapedForXml(const std::string& text);

/** A coordinate: one decimal. */
std::string svgNumber(double value);

/** 1, 2 or 5 times a power of ten: the smallest such step with which `span` needs at most `most` lines. */
double niceStep(double span, int most);

/** A figure with the decimals that a grid of this step needs. */
std::string onGrid(double value, double step);

/** Colours by their part in a picture. */
struct SvgPalette
{
	std::string background, ink, muted, grid, reference;
	std::vector<std::string> curves;
};

/** On white. The curves have Okabe and Ito's colours: told apart by the colour-blind, too. */
const SvgPalette& lightPalette();
/** Those of the page that the picture stands in (Html.h): light or dark as the reader's screen. */
const SvgPalette& pagePalette();

std::string svgText(double x, double y, const std::string& content, const std::string& attributes = {});
std::string svgLine(double x1, double y1, double x2, double y2);

/** Stroke of the curve of this index; dashed once the colours are used up. */
std::string svgCurveStyle(size_t index, const SvgPalette& colours);
/** A name in a legend, and the attributes of its stroke. */
struct SvgLegendEntry
{
	std::string name, style;
};

/** Adds lines of a legend from `top` on, as many names in a line as go in; returns where it ends. */
double svgLegend(const std::vector<SvgLegendEntry>& entries, double left, double top, double width, const SvgPalette& colours,
                 std::string& svg);

/** The whole picture. */
std::string svgPicture(double width, double height, const std::string& title, double title_x, const SvgPalette& colours,
                       const std::string& body);
}  // namespace viwo
