#include "Brightness.h"

#include <viwo/core/Ranking.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace viwo
{
namespace
{
constexpr int kSampleStride = 4;
constexpr int kSaturated = 250;
constexpr int kDarkest = 12, kBrightest = 243;  // outside of these, quantisation and clipping spoil the ratio
constexpr size_t kMinRatios = 100;
}  // namespace

bool hasLight(const cv::Mat& grey, double dark_level, double overexposed_share)
{
	std::array<int, 256> histogram{};
	int count = 0;
	for (int y = kSampleStride / 2; y < grey.rows; y += kSampleStride)
	{
		const uint8_t* row = grey.ptr<uint8_t>(y);
		for (int x = kSampleStride / 2; x < grey.cols; x += kSampleStride, ++count) ++histogram[row[x]];
	}
	int bright = 0, saturated = 0;
	for (int level = 255; level >= 0; --level)
	{
		if (level >= dark_level) bright += histogram[static_cast<size_t>(level)];
		if (level >= kSaturated) saturated += histogram[static_cast<size_t>(level)];
	}
	return bright > 0.05 * count && saturated <= overexposed_share * count;
}

double brightnessRatio(const cv::Mat& previous, const cv::Mat& current)
{
	std::vector<float> ratios;
	ratios.reserve(previous.total());
	for (int y = 0; y < previous.rows; ++y)
	{
		const uint8_t* p = previous.ptr<uint8_t>(y);
		const uint8_t* c = current.ptr<uint8_t>(y);
		for (int x = 0; x < previous.cols; ++x)
		{
			const bool exposed = p[x] >= kDarkest && p[x] <= kBrightest && c[x] >= kDarkest && c[x] <= kBrightest;
			if (exposed) ratios.push_back(static_cast<float>(c[x]) / static_cast<float>(p[x]));
		}
	}
	if (ratios.size() < kMinRatios) return 1;
	return upperMedian(ratios);
}

cv::Mat withGain(const cv::Mat& grey, double gain)
{
	cv::Mat scaled;
	grey.convertTo(scaled, CV_8U, gain);
	return scaled;
}
}  // namespace viwo
