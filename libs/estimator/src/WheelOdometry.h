#pragma once

#include <viwo/core/Pose3.h>
#include <viwo/estimator/EstimatorOptions.h>

#include <Eigen/Core>

namespace viwo
{
class WheelPreintegration;

/** Dead reckoning on the wheels alone (mode wheel): the pose of O relative to where it began, with its covariance from wheel noise, floors, and the
 *  uncertainty of scale and track.
 */
class WheelOdometry
{
   public:
	WheelOdometry(const EstimatorOptions& options, const WheelIntrinsics& nominal);

	void reset(const Pose3& T_WO);
	void add(const WheelPreintegration& interval);

	const Pose3& T_WO() const { return T_WO_; }
	/** [position in W's axes, rotation vector in O's axes]. */
	Eigen::Matrix<double, 6, 6> covariance() const;

   private:
	EstimatorOptions options_;
	WheelIntrinsics nominal_;
	Pose3 T_WO_;
	Eigen::Matrix<double, 6, 6> white_ = Eigen::Matrix<double, 6, 6>::Zero();
	Eigen::Matrix<double, 6, 3> by_intrinsics_ = Eigen::Matrix<double, 6, 3>::Zero();  //!< d[p, phi] / d(k_left, k_right, track)
};
}  // namespace viwo
