#pragma once

#include "Frame.h"

#include <viwo/core/Calibration.h>
#include <viwo/estimator/EstimatorOptions.h>

#include <deque>

namespace viwo
{
/** Tells when the wheels do not say what the robot does: their yaw against the gyro's, their travel against the prediction from IMU and window,
 *  summed over a short time so that a slip stands out of tick quantisation and white noise.
 */
class SlipGate
{
   public:
	SlipGate(const EstimatorOptions& options, const Calibration& calibration);

	/** @param before state of the frame that the interval starts from. @param intrinsics the present estimate.
	 *  Inflates the covariance of intervals that contradict, this one and those before it in the gate's time, and marks them.
	 *  @return whether this interval slips.
	 */
	bool judge(const NavState& before, Interval& interval, const WheelIntrinsics& intrinsics);

	/** Slips, where pauses shorter than a second do not start a new one. */
	int events() const { return events_; }
	void reset() { history_.clear(); }

   private:
	struct Comparison
	{
		double dt_s = 0;
		double yaw_rad = 0, yaw_variance = 0, travel_m = 0, travel_variance = 0;  //!< wheels less IMU, white part of the variance
		double speed_m_s = 0, yaw_rate_rad_s = 0;
	};
	Comparison compare(const NavState& before, const Interval& interval, const WheelIntrinsics& intrinsics) const;
	bool contradicts(const std::deque<Comparison>& comparisons) const;

	EstimatorOptions options_;
	Calibration calibration_;
	std::deque<Comparison> history_;
	double since_slip_s_ = 1e9;
	int events_ = 0;
};

/** Whether the robot stands over an interval: no wheel turned, and the gyro is quiet; where tracks are seen, they must not move either, since a robot
 *  can be pushed.
 */
bool standsStill(const Interval& interval, const Eigen::Vector3d& b_g, const FeatureFrame& before, const FeatureFrame& after, double sigma_rad);
}  // namespace viwo
