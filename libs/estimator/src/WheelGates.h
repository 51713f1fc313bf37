#pragma once

#include "Frame.h"

#include <viwo/core/Calibration.h>
#include <viwo/estimator/EstimatorOptions.h>

#include <deque>
#include <memory>
#include <optional>

namespace viwo
{
struct Window;

/** Tells when the wheels do not say what the robot does: their yaw against the gyro's, their travel against the prediction from IMU and
 * window. Both are summed from a state of up to slip_gate_window_s ago: a slip stands out of tick quantisation and white noise only with
 * time, and the states since then may have been bent by the slip itself.
 */
class SlipGate
{
   public:
	SlipGate(const EstimatorOptions& options, const Calibration& calibration);

	/** @param before state of the frame that the interval starts from, @param velocity_sigma_m_s and how well it knows its velocity.
	 *  @param intrinsics the present estimate.
	 *  @return for how long the wheels have been contradicting, s, this interval included; nothing where they do not.
	 */
	std::optional<double> judge(const NavState& before, double velocity_sigma_m_s, const Interval& interval,
	                            const WheelIntrinsics& intrinsics);

	/** Slips, where pauses shorter than a second do not start a new one. */
	int events() const { return events_; }
	void reset() { steps_.clear(); }
	void setMounting(const Pose3& T_OB) { calibration_.T_OB = T_OB; }

   private:
	struct Step
	{
		NavState before;
		double velocity_sigma_m_s = 0;
		std::shared_ptr<const ImuPreintegration> imu;  //!< a copy: the window merges its own
		Pose3 T_OiOj;                                  //!< of the wheels
		double yaw_variance = 0, travel_variance = 0;  //!< white part
		double distance_m = 0;
	};
	bool contradict(size_t first) const;
	double duration_s(size_t first) const;

	EstimatorOptions options_;
	Calibration calibration_;
	std::deque<Step> steps_;
	double since_slip_s_ = 1e9;
	int events_ = 0;
};

/** Inflates the covariance of the wheel intervals that end less than duration_s before the latest frame's, its own included. What is
 * inflated already stays as it is, also where it has been merged with what is not.
 */
void distrustWheels(Window& window, double duration_s);

/** Whether the robot stands over an interval: no wheel turned, and the gyro is quiet; where tracks are seen, they must not move either,
 * since a robot can be pushed.
 */
bool standsStill(const Interval& interval, const Eigen::Vector3d& b_g, const FeatureFrame& before, const FeatureFrame& after,
                 double sigma_rad);

/** standsStill() from frame to frame for a while, and tracks that have not crept away in that time. */
class StandstillGate
{
   public:
	bool judge(const Interval& interval, const Eigen::Vector3d& b_g, const FeatureFrame& before, const FeatureFrame& after,
	           double sigma_rad);
	void reset()
	{
		reference_ = {};
		quiet_since_ns_.reset();
	}

   private:
	FeatureFrame reference_;
	std::optional<int64_t> quiet_since_ns_;
};
}  // namespace viwo
