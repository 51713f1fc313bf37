#pragma once

#include <opencv2/core.hpp>

namespace viwo
{
/** Whether there is anything to see: the 95th percentile reaches dark_level and at most overexposed_share of the pixels are saturated. */
bool hasLight(const cv::Mat& grey, double dark_level, double overexposed_share);

/** Brightness of `current` over that of `previous` (small images of the same size): the median of the ratios pixel by pixel, which motion
 *  between the two hardly touches because what brightens one side of an edge darkens the other. 1 when too few pixels are well exposed.
 */
double brightnessRatio(const cv::Mat& previous, const cv::Mat& current);

/** min(255, gain * grey) */
cv::Mat withGain(const cv::Mat& grey, double gain);
}  // namespace viwo
