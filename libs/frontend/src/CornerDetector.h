#pragma once

#include <viwo/frontend/TrackerOptions.h>

#include <opencv2/core.hpp>
#include <vector>

namespace viwo
{
/** Shi-Tomasi corners where there are too few. The response is taken on the half-size image of the pyramid: a quarter of the cost, less
 * pixel noise, and a neighbourhood nearer to the window that the optical flow will use.
 */
class CornerDetector
{
   public:
	/** @param mask as of FeatureTracker, may be empty. */
	CornerDetector(cv::Size image_size, const TrackerOptions& options, const cv::Mat& mask);

	/** Moves corners to where the gradients of the optical flow's window meet (Foerstner's point; at most a few pixels). Seen from there a
	 * change of scale displaces the window by nothing, whereas off it every approach or retreat pulls the track along, and the pull adds
	 * up.
	 */
	void refine(const cv::Mat& grey, std::vector<cv::Point2f>& corners) const;

	/** Up to `wanted` new corners (full-size pixels), none nearer than min_distance_px to one of `taken` or to each other; first an equal
	 * share for each cell of the grid, then the best of the rest wherever they are.
	 */
	std::vector<cv::Point2f> detect(const cv::Mat& half_size_grey, const std::vector<cv::Point2f>& taken, int wanted) const;

	/** Whether a corner may be here: inside of the border and not masked. */
	bool allowed(const cv::Point2f& pixel) const;

   private:
	struct Candidate
	{
		cv::Point2f pixel;
		float response;
	};
	std::vector<Candidate> candidates(const cv::Mat& half_size_grey) const;
	size_t cellOf(const cv::Point2f& pixel) const;

	cv::Size size_;
	TrackerOptions options_;
	cv::Mat mask_;
};
}  // namespace viwo
