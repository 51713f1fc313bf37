#pragma once

#include <viwo/core/Calibration.h>
#include <viwo/core/FeatureFrame.h>
#include <viwo/sim/Motion.h>
#include <viwo/sim/World.h>

#include <functional>
#include <vector>

namespace viwo::sim
{
/** How makeFeatureFrames() plays the front-end. */
struct TrackOptions
{
	double rate_hz = 10;
	double begin_s = 0;           //!< true time of the first frame
	double end_s = -1;            //!< negative: the end of the motion
	double pixel_noise_px = 0.3;  //!< each coordinate, white
	size_t max_features = 150;
	int max_track_frames = 200;      //!< a track ends after so many frames
	double drop_probability = 0.01;  //!< a track is lost in each frame with this probability, its point comes back under a new id
	double outlier_probability = 0;  //!< an observation lies anywhere in the image
	double min_range_m = 0.3, max_range_m = 15;
	double clock_offset_s = 0;  //!< t_d: IMU time = camera time + t_d
	/** Whether a point is seen from a place (both in W); empty: always. */
	std::function<bool(const Eigen::Vector3d& from_W, const Eigen::Vector3d& point_W)> visible;
};

/** For TrackOptions::visible: nothing of the world stands between. `world` must outlive the result; its samplePoints() suit. */
std::function<bool(const Eigen::Vector3d& from_W, const Eigen::Vector3d& point_W)> visibleIn(const World& world);

/** n points on the six inner faces of an upright box, uniform over their area. */
std::vector<Eigen::Vector3d> randomRoomPoints(const Eigen::Vector3d& min_W, const Eigen::Vector3d& max_W, size_t n, uint64_t seed);

/** Feature tracks of known points as a front-end would give them, without images: projected through calibration.camera from the exact
 *  pose of T_OC, plus noise; bearings are those of the noisy pixels. Features are sorted by id, ids never return.
 */
std::vector<FeatureFrame> makeFeatureFrames(const Motion& motion, const Calibration& calibration,
                                            const std::vector<Eigen::Vector3d>& points_W, const TrackOptions& options, uint64_t seed);
std::vector<FeatureFrame> makeFeatureFrames(const Motion& motion, const Calibration& calibration,
                                            const std::vector<Eigen::Vector3d>& points_W, double pixel_noise_px, uint64_t seed);
}  // namespace viwo::sim
