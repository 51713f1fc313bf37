#include "OpticalFlow.h"

#include <algorithm>
#include <opencv2/video/tracking.hpp>

namespace viwo
{
namespace
{
// The way back starts at its expected end, so the coarse levels have nothing to find.
constexpr int kBackwardLevels = 1;

cv::Size windowOf(const TrackerOptions& options)
{
	return {options.window_px, options.window_px};
}
}  // namespace

FlowImage::FlowImage(const cv::Mat& grey, const TrackerOptions& options) : grey_(grey)
{
	levels_ = 1 + cv::buildOpticalFlowPyramid(grey, pyramid_, windowOf(options), options.pyramid_levels, true);
}

std::vector<FlowStatus> followCorners(const FlowImage& previous, const FlowImage& current, const std::vector<cv::Point2f>& previous_px,
                                      const TrackerOptions& options, std::vector<cv::Point2f>& current_px)
{
	std::vector<FlowStatus> status(previous_px.size(), FlowStatus::lost);
	if (previous_px.empty()) return status;
	const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, options.max_iterations, options.epsilon_px);
	const int top = std::min(previous.levels(), current.levels()) - 1;
	std::vector<uint8_t> forward_found, backward_found;
	std::vector<float> unused;
	cv::calcOpticalFlowPyrLK(previous.pyramid(), current.pyramid(), previous_px, current_px, forward_found, unused, windowOf(options), top,
	                         criteria, cv::OPTFLOW_USE_INITIAL_FLOW, options.min_eigenvalue);

	std::vector<cv::Point2f> returned_px = previous_px;
	cv::calcOpticalFlowPyrLK(current.pyramid(), previous.pyramid(), current_px, returned_px, backward_found, unused, windowOf(options),
	                         std::min(kBackwardLevels, top), criteria, cv::OPTFLOW_USE_INITIAL_FLOW, options.min_eigenvalue);

	for (size_t i = 0; i < status.size(); ++i)
	{
		if (!forward_found[i]) continue;
		const cv::Point2f gap = returned_px[i] - previous_px[i];
		const bool returns = backward_found[i] && gap.dot(gap) < options.forward_backward_px * options.forward_backward_px;
		status[i] = returns ? FlowStatus::tracked : FlowStatus::inconsistent;
	}
	return status;
}
}  // namespace viwo
