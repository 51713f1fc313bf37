#pragma once

#include <viwo/frontend/TrackerOptions.h>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace viwo
{
/** What a corner looked like when it was first seen, and how it has been seen to deform since.
 *
 *  Followed from image to image alone, a corner creeps: each step adds its error to the last one's, and a corner at the edge of a nearer
 * body slides along what lies behind it. On rendered corridors the noise of one frame is 0.03 px, but after 20 frames the median track is
 * off by 0.3 px and a tenth of the tracks by more than 1.3 px. Aligned with its first sight under an affine warp a true corner stays where
 * it was, and one that is no point of a surface gives itself away (Shi and Tomasi, "Good features to track", 1994).
 *
 *  Inverse-compositional Gauss-Newton (Baker and Matthews, "Lucas-Kanade 20 years on", 2004): gradient and Hessian are the reference's.
 * Mean and contrast are taken out, so that brightness does not matter.
 */
class ReferencePatch
{
   public:
	/** @returns nothing where the patch is not inside of the image, or has no texture in two directions. */
	static std::optional<ReferencePatch> at(const cv::Mat& grey, const cv::Point2f& centre_px, int side_px);

	/** The corner in another image. What is found is where the next search starts from.
	 *  @param near_px where optical flow sees it.
	 *  @returns nothing where the alignment does not converge, ends farther than options.reference_shift_px from there, or where the image
	 * is no more like the patch than options.reference_correlation. */
	std::optional<cv::Point2f> find(const cv::Mat& grey, const cv::Point2f& near_px, const TrackerOptions& options);

	/** Area of the patch in the latest image over its area in the reference. Far from 1 the two show different detail: take a new
	 * reference. */
	float magnification() const { return A_(0, 0) * A_(1, 1) - A_(0, 1) * A_(1, 0); }

   private:
	struct Warp
	{
		Eigen::Vector2f position_px;
		Eigen::Matrix2f A;
	};
	ReferencePatch() = default;
	/** The image under the patch, mean and contrast taken out; false outside of the image or without contrast. */
	bool sample(const cv::Mat& grey, const Warp& warp, Eigen::VectorXf& values) const;
	bool setGradients(const cv::Mat& grey, const Eigen::Vector2f& centre_px);
	/** One step of Gauss-Newton; the shift in pixels, nothing where the warp collapses. */
	std::optional<float> improve(const Eigen::VectorXf& seen, Warp& warp) const;

	int side_px_ = 0;
	Eigen::VectorXf values_;                            //!< mean 0, norm 1
	Eigen::Matrix<float, Eigen::Dynamic, 6> steepest_;  //!< d value / d (position, columns of A)
	Eigen::Matrix<float, 6, 6> covariance_;             //!< inverse of the Hessian
	Eigen::Matrix2f A_ = Eigen::Matrix2f::Identity();   //!< offset in the reference -> offset in the latest image
};
}  // namespace viwo
