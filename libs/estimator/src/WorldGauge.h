#pragma once

#include <viwo/core/Pose3.h>

#include <Eigen/Core>

namespace viwo
{
/** Position and heading of a window's start in W. A window knows its states against its start only, which it holds fixed; how far the start
 * itself is from where it is said to be comes on top here, and turns everything since about the start.
 */
class WorldGauge
{
   public:
	using Matrix6 = Eigen::Matrix<double, 6, 6>;

	/** A window starts with O at T_WO, known with this covariance (position in W's axes, rotation vector in O's). */
	void startAt(const Pose3& T_WO, const Matrix6& covariance);

	/** Covariance of O in W, in the order and axes of startAt(). @param in_window the same against the window's start. */
	Matrix6 covarianceOf(const Pose3& T_WO, const Matrix6& in_window) const;

   private:
	Eigen::Vector3d p_WO_start_ = Eigen::Vector3d::Zero();
	Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Zero();  //!< of position and of yaw about W's z
};

/** Covariance of T_WO = T_WB T_BO from that of T_WB; position in W's axes, rotations perturbed on the right. */
Eigen::Matrix<double, 6, 6> vehicleCovariance(const Pose3& T_WB, const Pose3& T_BO, const Eigen::Matrix<double, 6, 6>& of_T_WB);
}  // namespace viwo
