#pragma once

#include <viwo/core/NavState.h>
#include <viwo/core/WheelSample.h>
#include <viwo/estimator/EstimatorOptions.h>

#include <Eigen/Core>

#include "WheelPreintegration.h"

namespace viwo
{
class WheelBuffer;

/** Dead reckoning on the wheels from where O was last known: mode wheel, and in the other modes while there is no window. Its covariance
 * goes on from that of the last known pose, by wheel noise, floors, and the uncertainty of scale and track; over what no wheel tells it
 * grows by what a robot could have done meanwhile.
 */
class WheelOdometry
{
   public:
	using Covariance = Eigen::Matrix<double, 6, 6>;

	/** Wheels as configured, with the configured deviations, until setIntrinsics(). */
	WheelOdometry(const EstimatorOptions& options, const WheelIntrinsics& nominal);

	/** O is known at t_ns. @param covariance [position in W's axes, rotation vector in O's axes]. @param twist how it moves there. */
	void reset(int64_t t_ns, const Pose3& T_WO, const Covariance& covariance = Covariance::Zero(), const WheelTwist& twist = {});
	/** From here on. @param covariance of (k_left, k_right, track_m). */
	void setIntrinsics(const WheelIntrinsics& wheels, const Eigen::Matrix3d& covariance);

	void add(const WheelPreintegration& interval);

	/** Carries O on to t_ns as far as the wheels tell: over a hole in their stream that is closed again, by passUnknown(); at one that is
	 * still open it waits at its start. @return whether all of the way was told.
	 */
	bool advance(const WheelBuffer& wheels, int64_t t_ns);
	/** Stays where it is until t_ns, and knows that much less of it. */
	void passUnknown(int64_t t_ns);

	/** Until when O is known. */
	int64_t t_ns() const { return t_ns_; }
	const Pose3& T_WO() const { return T_WO_; }
	/** [position in W's axes, rotation vector in O's axes]. */
	Covariance covariance() const;
	/** B's state with the pose and the motion of O; no biases. */
	NavState bodyState(const Pose3& T_OB) const;
	/** Holes in the wheel stream that advance() has met. */
	int gaps() const { return gaps_; }

   private:
	WheelNoise noise_;
	double max_gap_s_;
	WheelIntrinsics wheels_;
	Eigen::Matrix3d wheels_covariance_;
	int64_t t_ns_ = 0;
	Pose3 T_WO_;
	WheelTwist twist_;
	Covariance white_ = Covariance::Zero();
	WheelPreintegration::IntrinsicsJacobian by_intrinsics_ = WheelPreintegration::IntrinsicsJacobian::Zero();
	bool in_gap_ = false;
	int gaps_ = 0;
};

/** B's state where O is at T_WO and moves with this twist. */
NavState bodyStateAt(const Pose3& T_WO, const Pose3& T_OB, const WheelTwist& twist);
}  // namespace viwo
