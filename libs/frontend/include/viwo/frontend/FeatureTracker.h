#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/FeatureFrame.h>
#include <viwo/frontend/TrackerOptions.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

namespace viwo
{
/** What became of the features in one call of FeatureTracker::track(). */
struct TrackerStats
{
	bool usable = false;  //!< false: black, overexposed or missing image
	int tracked = 0;      //!< carried over from the image before
	int lost_flow = 0;    //!< optical flow failed, or the corner left the image
	int lost_forward_backward = 0;
	int lost_changed = 0;  //!< no longer looks as it did at first
	int lost_ransac = 0;   //!< disagrees with a rigid scene
	int lost_crowded = 0;  //!< came too close to an older corner, or into the mask
	int detected = 0;      //!< new
	double gain = 1;       //!< brightness of this image over that of the one before
};

/** Finds corners (Shi-Tomasi, spread over a grid) and follows them from image to image (pyramidal Lucas-Kanade, started where the gyroscope
 *  predicts them), as in Niu et al. Sec. 4.1, then puts each back to what it was at first sight, so that no track drifts. What a track
 * disagrees with (itself when followed backwards, its first sight, the epipolar geometry) ends it.
 *
 *  Deterministic: the same images give the same frames, whatever the number of OpenCV's threads. No global is touched: a program that wants
 *  OpenCV on one thread calls cv::setNumThreads(1) itself.
 */
class FeatureTracker
{
   public:
	/** @param mask 8-bit, of the camera's size; corners only where it is not 0. Empty: what options.mask_path names, else everywhere.
	 *  @throws Error when the camera has no size or focal length, or the mask cannot be read or is of another size or type.
	 */
	FeatureTracker(const CameraModel& camera, const TrackerOptions& options, const cv::Mat& mask = {});
	~FeatureTracker();
	FeatureTracker(FeatureTracker&&) noexcept;
	FeatureTracker& operator=(FeatureTracker&&) noexcept;

	/** Features of the next image.
	 *  @param grey 8-bit, one channel, of the camera's size; empty where there is none.
	 *  @param R_Cprev_Ccur rotation since the last call, x_prev = R x_cur; without it the images alone must tell (five-point essential
	 * matrix).
	 *  @return features sorted by id; none when the image is unusable (see stats()): then all tracks end.
	 *  @throws Error for an image of another size or type.
	 */
	FeatureFrame track(int64_t t_ns, const cv::Mat& grey, const std::optional<Eigen::Quaterniond>& R_Cprev_Ccur = std::nullopt);

	/** Ends all tracks; ids go on counting. */
	void reset();

	const TrackerStats& stats() const;

   private:
	class Impl;
	std::unique_ptr<Impl> impl_;
};
}  // namespace viwo
