#pragma once

#include "Belief.h"
#include "Frame.h"
#include "LandmarkMap.h"
#include "Marginalizer.h"

#include <viwo/core/Calibration.h>
#include <viwo/estimator/EstimatorOptions.h>

#include <array>
#include <deque>
#include <memory>
#include <vector>

namespace viwo
{
class LinearPrior;

/** All states of the sliding window (paper Eq. 14) and what is known of them beside the measurements. Plain data: the algorithms stand
 * beside it. */
struct Window
{
	Window(const EstimatorOptions& options, const Calibration& calibration);

	/** No frame any more; calibration as this belief has it. */
	void clear(const Belief& belief);

	EstimatorOptions options;
	Calibration calibration;  //!< with T_BO as adoptMounting() left it
	Belief belief;            //!< from before the first frame

	std::deque<std::unique_ptr<Frame>> frames;  //!< oldest first; addresses of the states are stable
	LandmarkMap landmarks;

	std::array<double, 7> T_BC{};
	std::array<double, 3> wheels{};  //!< k_left, k_right, track_m
	std::array<double, 7> T_BO{};
	double t_d_s = 0, t_w_s = 0;  //!< t_IMU = t_CAM + t_d = t_WHEEL + t_w
	Excitation excitation;
	std::array<double, 3>& plane() { return planes[static_cast<size_t>(current_plane)]; }
	const std::array<double, 3>& plane() const { return planes[static_cast<size_t>(current_plane)]; }
	std::array<std::array<double, 3>, 2> planes{};  //!< the floor now, and room for the next one (its random walk)
	int current_plane = 0;

	std::vector<Factor> start_priors;    //!< of the initial states, until marginalisation takes them in
	std::shared_ptr<LinearPrior> prior;  //!< what marginalisation has left; null before the first
	std::vector<double*> prior_blocks;

	Frame& latest() { return *frames.back(); }
	const Frame& latest() const { return *frames.back(); }
	Pose3 T_BC_pose() const;
	Pose3 T_BO_pose() const;
	WheelIntrinsics wheelIntrinsics() const;
	ClockOffsets offsets() const { return {t_d_s, t_w_s}; }

	/** Where T_BO is estimated: what asks the calibration has the estimate from now on. */
	void adoptMounting();
};

/** Every factor of the window in a fixed order, with first-estimate Jacobians on the states that the prior holds. Whether a landmark's
 * sighting is defined at the present states is looked at here.
 */
std::vector<Factor> collectFactors(Window& window);
}  // namespace viwo
