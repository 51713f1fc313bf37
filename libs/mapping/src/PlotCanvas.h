#pragma once

#include <viwo/mapping/MapPlot.h>

#include <memory>

namespace viwo
{
enum class TextAnchor
{
	start,
	middle,
	end
};

/** What a picture is drawn on. Pixels, y down. */
class PlotCanvas
{
   public:
	virtual ~PlotCanvas() = default;

	virtual void fill(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, PlotColour colour) = 0;
	/** Cells of a map, `factor` pixels each, upper left corner at `corner`. */
	virtual void cells(const Eigen::Vector2d& corner, const OccupancyImage& map, int factor) = 0;
	virtual void polyline(const std::vector<Eigen::Vector2d>& points, PlotColour colour, double width) = 0;
	virtual void dot(const Eigen::Vector2d& centre, PlotColour colour, double radius) = 0;
	virtual void text(const Eigen::Vector2d& base, const std::string& content, PlotColour colour, TextAnchor anchor) = 0;
	/** The file's content. */
	virtual std::string finish() = 0;
};

std::unique_ptr<PlotCanvas> pngCanvas(int width_px, int height_px);
std::unique_ptr<PlotCanvas> svgCanvas(int width_px, int height_px);

/** One byte a pixel, as a PNG file. */
std::string greyPng(const OccupancyImage& map);
}  // namespace viwo
