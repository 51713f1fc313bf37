#include <mrpt/core/format.h>
#include <viwo/core/Svg.h>

#include "PlotCanvas.h"

namespace viwo
{
namespace
{
std::string base64(const std::string& bytes)
{
	static const char* const kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	std::string text;
	for (size_t i = 0; i < bytes.size(); i += 3)
	{
		uint32_t three = 0;
		for (size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
		for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kLetters[three >> (18 - 6 * k) & 63u];
	}
	return text;
}

std::string hex(PlotColour c)
{
	return mrpt::format("#%02x%02x%02x", c.red, c.green, c.blue);
}

class SvgCanvas : public PlotCanvas
{
   public:
	SvgCanvas(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {}

	void fill(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, PlotColour colour) override
	{
		body_ += "<rect x=\"" + svgNumber(corner.x()) + "\" y=\"" + svgNumber(corner.y()) + "\" width=\"" + svgNumber(size.x()) +
		         "\" height=\"" + svgNumber(size.y()) + "\" fill=\"" + hex(colour) + "\"/>\n";
	}

	void cells(const Eigen::Vector2d& corner, const OccupancyImage& map, int factor) override
	{
		body_ += "<image x=\"" + svgNumber(corner.x()) + "\" y=\"" + svgNumber(corner.y()) + "\" width=\"" +
		         std::to_string(map.columns * factor) + "\" height=\"" + std::to_string(map.rows * factor) +
		         "\" style=\"image-rendering:pixelated\" href=\"data:image/png;base64," + base64(greyPng(map)) + "\"/>\n";
	}

	void polyline(const std::vector<Eigen::Vector2d>& points, PlotColour colour, double width) override
	{
		body_ += "<polyline fill=\"none\" stroke-linejoin=\"round\" stroke=\"" + hex(colour) + "\" stroke-width=\"" + svgNumber(width) +
		         "\" points=\"";
		for (const Eigen::Vector2d& p : points) body_ += svgNumber(p.x()) + "," + svgNumber(p.y()) + " ";
		body_ += "\"/>\n";
	}

	void dot(const Eigen::Vector2d& centre, PlotColour colour, double radius) override
	{
		body_ += "<circle cx=\"" + svgNumber(centre.x()) + "\" cy=\"" + svgNumber(centre.y()) + "\" r=\"" + svgNumber(radius) +
		         "\" fill=\"" + hex(colour) + "\"/>\n";
	}

	void text(const Eigen::Vector2d& base, const std::string& content, PlotColour colour, TextAnchor anchor) override
	{
		static const char* const kAnchors[] = {"start", "middle", "end"};
		body_ += svgText(base.x(), base.y(), content,
		                 "font-size=\"13\" fill=\"" + hex(colour) + "\" text-anchor=\"" + kAnchors[static_cast<size_t>(anchor)] + "\"");
	}

	std::string finish() override { return svgPicture(width_px_, height_px_, "", 0, lightPalette(), body_); }

   private:
	int width_px_, height_px_;
	std::string body_;
};
}  // namespace

std::unique_ptr<PlotCanvas> svgCanvas(int width_px, int height_px)
{
	return std::make_unique<SvgCanvas>(width_px, height_px);
}
}  // namespace viwo
