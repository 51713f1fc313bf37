#include "MapPicture.h"

#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cstdio>

namespace viwo::gt
{
namespace
{
cv::Scalar colourOf(PoseFlag flag)
{
	switch (flag)
	{
		case PoseFlag::good:
			return {60, 160, 40};
		case PoseFlag::degenerate:
			return {0, 140, 255};
		case PoseFlag::odometry_only:
			break;
	}
	return {40, 40, 220};
}

/** 1, 2 or 5 times a power of ten metres, about a sixth of the width. */
double barLength_m(double width_m)
{
	const double decade = std::pow(10, std::floor(std::log10(std::max(width_m / 6, 0.01))));
	for (const double step : {5.0, 2.0})
		if (step * decade <= width_m / 6) return step * decade;
	return decade;
}
}  // namespace

void writeMapPicture(const std::string& path, const MapImage& map, const std::vector<FinalPose>& poses)
{
	constexpr int kMargin_px = 40;
	const cv::Mat cells(map.rows, map.columns, CV_8U, const_cast<uint8_t*>(map.cells.data()));
	const int factor = std::max(1, 900 / std::max(map.rows, map.columns));
	cv::Mat grey, picture;
	cv::resize(cells, grey, {}, factor, factor, cv::INTER_NEAREST);
	cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
	cv::copyMakeBorder(picture, picture, 0, kMargin_px, 0, 0, cv::BORDER_CONSTANT, cv::Scalar(255, 255, 255));

	constexpr int kShift = 4;
	const auto pixel = [&](const Pose2& T)
	{
		const double scale = factor / map.resolution_m * (1 << kShift);
		return cv::Point(static_cast<int>((T.p.x() - map.min_x_m) * scale),
		                 static_cast<int>((map.rows * map.resolution_m - (T.p.y() - map.min_y_m)) * scale));
	};
	for (size_t i = 1; i < poses.size(); ++i)
		cv::line(picture, pixel(poses[i - 1].T), pixel(poses[i].T), colourOf(poses[i].flag), 1, cv::LINE_AA, kShift);

	const double length_m = barLength_m(map.columns * map.resolution_m);
	const int y = picture.rows - kMargin_px / 2, right = 10 + static_cast<int>(length_m / map.resolution_m * factor);
	cv::line(picture, {10, y}, {right, y}, {0, 0, 0}, 3);
	char label[32];
	std::snprintf(label, sizeof label, "%g m", length_m);
	cv::putText(picture, label, {right + 8, y + 5}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {0, 0, 0}, 1, cv::LINE_AA);

	std::vector<uchar> bytes;
	if (!cv::imencode(".png", picture, bytes)) throw Error(path + ": cannot be coded as PNG");
	AtomicFile file(path);
	file.stream().write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
	file.commit();
}
}  // namespace viwo::gt
