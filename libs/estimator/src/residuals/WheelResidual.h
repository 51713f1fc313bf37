#pragma once

#include "WheelPreintegration.h"
#include "residuals/LocalCost.h"

#include <viwo/core/Pose3.h>

#include <Eigen/Core>

namespace viwo
{
/** Two frames and the wheels' travel between them (Niu et al. Eq. 19, with all terms in O). R_WO = R_WB R_BO, p_WO = p_WB + R_WB p_BO:
 *
 *      r_p   = R_WOi^T (p_WOj - p_WOi) - dp(k),   r_phi = Log(dR(k)^T R_WOi^T R_WOj)
 *
 *  with, to first order in the change d of the intrinsics since the preintegration, dp + J_p d and dR Exp(theta), theta = J_phi d.
 *  The lever arm is here only and not in the preintegration.
 *
 *  Blocks: pose T_WB_i, pose T_WB_j, wheel intrinsics (k_left, k_right, track in m). Six residuals.
 */
class WheelResidual : public LocalCost
{
   public:
	using Whitening = Eigen::Matrix<double, 6, 6>;

	/** Copies what it needs.
	 *  @param covariance_inflation factor on the covariance, > 1 when the wheels are thought to have slipped. */
	WheelResidual(const WheelPreintegration& preintegration, const Pose3& T_BO, double covariance_inflation = 1);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

	/** The lower triangular factor that is applied to the rows [r_p, r_phi]. */
	const Whitening& whiteningFactor() const { return whiten_; }

   private:
	Eigen::Vector3d dp_;
	Eigen::Quaterniond dR_;
	WheelPreintegration::IntrinsicsJacobian intrinsics_jacobian_;
	Eigen::Vector3d intrinsics_;
	Pose3 T_BO_;
	Whitening whiten_;
};
}  // namespace viwo
