#include <viwo/core/Error.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "PlotCanvas.h"

namespace viwo
{
namespace
{
constexpr int kShift = 4;  //!< binary places of OpenCV's coordinates
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.45;

std::string encoded(const cv::Mat& picture)
{
	std::vector<uchar> bytes;
	if (!cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9})) throw Error("the picture cannot be coded as PNG");
	return {bytes.begin(), bytes.end()};
}

cv::Mat asMat(const OccupancyImage& map)
{
	return cv::Mat(map.rows, map.columns, CV_8U, const_cast<uint8_t*>(map.cells.data()));
}

/** OpenCV's fonts have no other letters: one question mark for each character. */
std::string inAscii(const std::string& utf8)
{
	std::string text;
	for (const char c : utf8)
	{
		const auto byte = static_cast<unsigned char>(c);
		const bool continues = (byte & 0xC0u) == 0x80u;
		if (!continues) text += byte >= 0x20 && byte < 0x7F ? c : '?';
	}
	return text;
}

class PngCanvas : public PlotCanvas
{
   public:
	PngCanvas(int width_px, int height_px) : picture_(height_px, width_px, CV_8UC3, cv::Scalar(255, 255, 255)) {}

	void fill(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, PlotColour colour) override
	{
		const auto pixels = [](const Eigen::Vector2d& v)
		{ return cv::Point(static_cast<int>(std::lround(v.x())), static_cast<int>(std::lround(v.y()))); };
		cv::rectangle(picture_, cv::Rect(pixels(corner), pixels(corner + size)), bgr(colour), cv::FILLED);
	}

	void cells(const Eigen::Vector2d& corner, const OccupancyImage& map, int factor) override
	{
		cv::Mat grey, colour;
		cv::resize(asMat(map), grey, {}, factor, factor, cv::INTER_NEAREST);
		cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
		const cv::Rect all(0, 0, picture_.cols, picture_.rows);
		const cv::Rect place(static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y())), colour.cols,
		                     colour.rows);
		const cv::Rect seen = place & all;
		if (seen.area() > 0) colour(seen - place.tl()).copyTo(picture_(seen));
	}

	void polyline(const std::vector<Eigen::Vector2d>& points, PlotColour colour, double width) override
	{
		for (size_t i = 1; i < points.size(); ++i)
			cv::line(picture_, at(points[i - 1]), at(points[i]), bgr(colour), std::max(1, static_cast<int>(std::lround(width))),
			         cv::LINE_AA, kShift);
	}

	void dot(const Eigen::Vector2d& centre, PlotColour colour, double radius) override
	{
		cv::circle(picture_, at(centre), static_cast<int>(radius * (1 << kShift)), bgr(colour), cv::FILLED, cv::LINE_AA, kShift);
	}

	void text(const Eigen::Vector2d& base, const std::string& given, PlotColour colour, TextAnchor anchor) override
	{
		const std::string content = inAscii(given);
		int below = 0;
		const int width = cv::getTextSize(content, kFont, kFontScale, 1, &below).width;
		const int left = anchor == TextAnchor::start ? 0 : anchor == TextAnchor::middle ? width / 2 : width;
		const cv::Point origin(static_cast<int>(base.x()) - left, static_cast<int>(base.y()));
		cv::putText(picture_, content, origin, kFont, kFontScale, bgr(colour), 1, cv::LINE_AA);
	}

	std::string finish() override { return encoded(picture_); }

   private:
	static cv::Scalar bgr(PlotColour c) { return {double(c.blue), double(c.green), double(c.red)}; }
	static cv::Point at(const Eigen::Vector2d& p)
	{
		const double scale = 1 << kShift;
		return {static_cast<int>(std::lround(p.x() * scale)), static_cast<int>(std::lround(p.y() * scale))};
	}

	cv::Mat picture_;
};
}  // namespace

std::string greyPng(const OccupancyImage& map)
{
	return encoded(asMat(map));
}

std::unique_ptr<PlotCanvas> pngCanvas(int width_px, int height_px)
{
	return std::make_unique<PngCanvas>(width_px, height_px);
}
}  // namespace viwo
