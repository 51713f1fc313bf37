#pragma once

#include <Eigen/Core>
#include <vector>

#include "ScaleAlignment.h"

namespace viwo
{
/** The linear system of ScaleAlignment.h and its noise. Rows: 9 an interval with wheels, 6 without (camera + IMU, IMU, camera + wheels). */
class ScaleAlignmentRows
{
   public:
	using Index = Eigen::Index;

	ScaleAlignmentRows(const std::vector<Pose3>& T_c0_ck, const std::vector<ImuPreintegration>& imu,
	                   const std::vector<WheelPreintegration>& wheels, const Calibration& calibration, const Belief& belief);

	Index intervals() const { return n_; }
	Index rows() const { return n_ * rows_per_interval_; }
	/** Unknowns without gravity: velocities, then scale. */
	Index scaleColumn() const { return 3 * (n_ + 1); }

	/** A x = b with unknowns [v_0 ... v_n, s, w], g_c0 = nominal_g_c0 + basis w. */
	void system(const Eigen::Vector3d& nominal_g_c0, const Eigen::MatrixXd& basis, Eigen::MatrixXd& A, Eigen::VectorXd& b) const;

	/** Derivative of A x - b with respect to vision's intervals (SfmResult::interval_covariance) at x = [v, s, ...] under gravity g_c0. */
	Eigen::MatrixXd visionJacobian(const Eigen::VectorXd& x, const Eigen::Vector3d& g_c0) const;

	/** Covariance of A x - b from all but vision: IMU, wheels, and what is constant over the window. */
	Eigen::MatrixXd sensorCovariance() const;

	/** Mean specific force of the window in c0, direction only as good as the motion is unaccelerated. */
	Eigen::Vector3d meanSpecificForce_c0() const;

   private:
	Eigen::Matrix3d R_b_c0(Index k) const { return R_BC_ * R_c0_c(k).transpose(); }
	Eigen::Matrix3d R_c0_c(Index k) const { return T_c0_ck_[static_cast<size_t>(k)].R.toRotationMatrix(); }
	Eigen::Matrix3d R_b_next(Index k) const { return R_BC_ * R_c0_c(k).transpose() * R_c0_c(k + 1) * R_BC_.transpose(); }
	Eigen::Vector3d visionStep_b(Index k) const;

	const std::vector<Pose3>& T_c0_ck_;
	const std::vector<ImuPreintegration>& imu_;
	const std::vector<WheelPreintegration>& wheels_;
	const Belief& belief_;
	Index n_, rows_per_interval_;
	Eigen::Matrix3d R_BC_, R_BO_;
	Eigen::Vector3d p_BC_, p_BO_;
};
}  // namespace viwo
