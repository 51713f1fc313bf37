#include "CornerDetector.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace viwo
{
namespace
{
constexpr int kBlock_px = 5;  // of the half-size image
constexpr int kRefineIterations = 10;
constexpr double kRefineEpsilon_px = 0.02;
constexpr float kMaxRefine_px = 6;

bool isFree(const cv::Point2f& pixel, const std::vector<cv::Point2f>& taken, double distance_px)
{
	const double limit = distance_px * distance_px;
	return std::none_of(taken.begin(), taken.end(),
	                    [&](const cv::Point2f& other)
	                    {
		                    const cv::Point2f d = pixel - other;
		                    return d.dot(d) < limit;
	                    });
}
}  // namespace

CornerDetector::CornerDetector(cv::Size image_size, const TrackerOptions& options, const cv::Mat& mask)
    : size_(image_size), options_(options), mask_(mask)
{
}

bool CornerDetector::allowed(const cv::Point2f& pixel) const
{
	const int x = cvRound(pixel.x), y = cvRound(pixel.y), b = options_.border_px;
	if (x < b || y < b || x >= size_.width - b || y >= size_.height - b) return false;
	return mask_.empty() || mask_.at<uint8_t>(y, x) != 0;
}

size_t CornerDetector::cellOf(const cv::Point2f& pixel) const
{
	const int column = std::clamp(static_cast<int>(pixel.x) * options_.grid_columns / size_.width, 0, options_.grid_columns - 1);
	const int row = std::clamp(static_cast<int>(pixel.y) * options_.grid_rows / size_.height, 0, options_.grid_rows - 1);
	return static_cast<size_t>(row) * static_cast<size_t>(options_.grid_columns) + static_cast<size_t>(column);
}

std::vector<CornerDetector::Candidate> CornerDetector::candidates(const cv::Mat& half_size_grey) const
{
	cv::Mat response, neighbourhood_max;
	cv::cornerMinEigenVal(half_size_grey, response, kBlock_px);
	cv::dilate(response, neighbourhood_max, cv::Mat());
	double best = 0;
	cv::minMaxLoc(response, nullptr, &best);
	const auto threshold = static_cast<float>(std::max(options_.min_response, options_.quality * best));

	std::vector<Candidate> found;
	for (int y = 1; y + 1 < response.rows; ++y)
	{
		const float* r = response.ptr<float>(y);
		const float* m = neighbourhood_max.ptr<float>(y);
		for (int x = 1; x + 1 < response.cols; ++x)
		{
			if (r[x] < threshold || r[x] < m[x]) continue;
			// The pyramid keeps every second pixel, from the first on.
			const cv::Point2f pixel(2.f * static_cast<float>(x), 2.f * static_cast<float>(y));
			if (allowed(pixel)) found.push_back({pixel, r[x]});
		}
	}
	std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) { return a.response > b.response; });
	return found;
}

std::vector<cv::Point2f> CornerDetector::detect(const cv::Mat& half_size_grey, const std::vector<cv::Point2f>& taken, int wanted) const
{
	std::vector<cv::Point2f> chosen;
	if (wanted <= 0) return chosen;
	const int cells = options_.grid_columns * options_.grid_rows;
	const int share = (options_.max_features + cells - 1) / cells;
	std::vector<int> count(static_cast<size_t>(cells), 0);
	for (const cv::Point2f& p : taken) ++count[cellOf(p)];

	const std::vector<Candidate> found = candidates(half_size_grey);
	std::vector<cv::Point2f> occupied = taken;
	const auto take = [&](bool only_within_share)
	{
		for (const Candidate& c : found)
		{
			if (static_cast<int>(chosen.size()) >= wanted) return;
			int& in_cell = count[cellOf(c.pixel)];
			if ((only_within_share && in_cell >= share) || !isFree(c.pixel, occupied, options_.min_distance_px)) continue;
			++in_cell;
			chosen.push_back(c.pixel);
			occupied.push_back(c.pixel);
		}
	};
	take(true);
	take(false);
	return chosen;
}

void CornerDetector::refine(const cv::Mat& grey, std::vector<cv::Point2f>& corners) const
{
	if (corners.empty()) return;
	const int half = options_.window_px / 2;
	std::vector<cv::Point2f> refined = corners;
	cv::cornerSubPix(grey, refined, cv::Size(half, half), cv::Size(-1, -1),
	                 cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kRefineIterations, kRefineEpsilon_px));
	for (size_t i = 0; i < corners.size(); ++i)
	{
		const cv::Point2f move = refined[i] - corners[i];
		if (move.dot(move) < kMaxRefine_px * kMaxRefine_px && allowed(refined[i])) corners[i] = refined[i];
	}
}
}  // namespace viwo
