#pragma once

#include "ImuPreintegration.h"
#include "TimeShift.h"
#include "residuals/LocalCost.h"

#include <Eigen/Core>

namespace viwo
{
/** Two frames and the IMU between them (Niu et al. Eq. 18, with the rotation error written so that it vanishes at the truth, and gravity,
 *  g_up = [0, 0, |g|], here only and not in the preintegration). Rows in StateOrder, before whitening:
 *
 *      r_p   = R_i^T (p_j - p_i - v_i dt + 1/2 g_up dt^2) - alpha(b_i)
 *      r_phi = Log(gamma(b_i)^T R_i^T R_j)
 *      r_v   = R_i^T (v_j - v_i + g_up dt) - beta(b_i)
 *      r_b   = b_j - b_i
 *
 *  with, to first order in the change d of the biases since the preintegration, alpha + J_alpha d, beta + J_beta d,
 *  gamma Exp(theta), theta = J_phi d; hence dr_phi = -J_r^-1(r_phi) Exp(r_phi)^T J_r(theta) J_phi dd.
 *
 *  Where the offset of the frames' clock is estimated too (t_IMU = t_CAM + t_d), the interval's shift adds to the correction of alpha,
 *  gamma and beta: S (t_d - t_d0).
 *
 *  Blocks: pose T_WB_i, motion_i (v, b_a, b_g), pose T_WB_j, motion_j; with a shift also t_d (s). 15 residuals.
 */
class ImuResidual : public LocalCost
{
   public:
	using Whitening = Eigen::Matrix<double, 15, 15>;

	/** Copies what it needs. */
	ImuResidual(const ImuPreintegration& preintegration, double gravity_m_s2);
	/** With the block of the offset. */
	ImuResidual(const ImuPreintegration& preintegration, double gravity_m_s2, const ImuTimeShift& shift);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

	/** The lower triangular factor that is applied to the rows. */
	const Whitening& whiteningFactor() const { return whiten_; }

   private:
	ImuResidual(const ImuPreintegration& preintegration, double gravity_m_s2, std::vector<BlockShape> shapes, const ImuTimeShift& shift);

	using Vector15 = Eigen::Matrix<double, 15, 1>;
	/** What residual and Jacobians share. */
	struct Terms
	{
		Eigen::Matrix3d R_BiW, R_BjBi;
		Eigen::Vector3d travel, speed_change;  //!< by the states, in B_i
		Eigen::Vector3d theta;                 //!< correction of gamma
	};
	/** @param r the residual before whitening. */
	Terms evaluate(double const* const* x, Vector15& r) const;

	ImuDelta delta_;
	ImuPreintegration::BiasJacobian bias_jacobian_;
	Eigen::Vector3d b_a_, b_g_;
	double dt_s_;
	Eigen::Vector3d g_up_;
	ImuTimeShift shift_;
	Whitening whiten_;
};
}  // namespace viwo
