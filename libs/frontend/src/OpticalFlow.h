#pragma once

#include <viwo/frontend/TrackerOptions.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace viwo
{
/** One image, its halvings and their gradients, made once and used three times: as the target of the forward flow, as the origin of the
 * backward flow, and as the origin of the next image's forward flow.
 */
class FlowImage
{
   public:
	FlowImage() = default;
	FlowImage(const cv::Mat& grey, const TrackerOptions& options);

	bool empty() const { return grey_.empty(); }
	const cv::Mat& grey() const { return grey_; }
	/** Level 0 is the image itself. */
	const cv::Mat& level(int i) const { return pyramid_[2 * static_cast<size_t>(i)]; }
	int levels() const { return levels_; }
	const std::vector<cv::Mat>& pyramid() const { return pyramid_; }

   private:
	cv::Mat grey_;
	std::vector<cv::Mat> pyramid_;  //!< image, gradient, image, gradient ...
	int levels_ = 0;
};

enum class FlowStatus : uint8_t
{
	tracked,
	lost,
	inconsistent  //!< does not come back to where it started
};

/** Pyramidal Lucas-Kanade from `previous` to `current`, and back.
 *  @param current_px in: predictions; out: positions where the status is `tracked`.
 */
std::vector<FlowStatus> followCorners(const FlowImage& previous, const FlowImage& current, const std::vector<cv::Point2f>& previous_px,
                                      const TrackerOptions& options, std::vector<cv::Point2f>& current_px);
}  // namespace viwo
