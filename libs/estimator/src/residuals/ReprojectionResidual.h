#pragma once

#include "residuals/LocalCost.h"

#include <Eigen/Core>

namespace viwo
{
/** A landmark anchored in frame i and seen again in frame j (Niu et al. Eq. 16-17).
 *
 *  lambda is the inverse distance along the unit bearing b_i. Times lambda > 0, the landmark is, without a division,
 *
 *      x_Bi = R_BC b_i + lambda p_BC                         (in B_i)
 *      x_Bj = R_j^T (R_i x_Bi + lambda (p_i - p_j))          (in B_j)
 *      f    = R_BC^T (x_Bj - lambda p_BC)                    (in C_j)
 *      r    = A^T f / |f| / sigma,   df/|f| = (I - u u^T) df / |f|,  u = f / |f|
 *
 *  A: two tangents of the measured bearing b_j (3x2). The error is also zero where f points away from b_j, so b_j^T f <= 0 is not valid.
 *  A lambda <= 0 is beyond infinity: valid() refuses it, but the residual goes on smoothly, so that one far landmark whose step overshoots
 * does not make the solver reject the step of all states.
 *
 *  Blocks: pose T_WB_i, pose T_WB_j, pose T_BC, inverse depth lambda (1/m). Two residuals.
 */
class ReprojectionResidual : public LocalCost
{
   public:
	/** @param bearing_anchor, bearing_j measured directions in C_i and C_j; normalised here.
	 *  @param sigma_rad pixel noise over the focal length. */
	ReprojectionResidual(const Eigen::Vector3d& bearing_anchor, const Eigen::Vector3d& bearing_j, double sigma_rad);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

	/** Whether the landmark is in front of both cameras. An observation of which this is false is left out of the problem. */
	bool valid(const double* T_WB_i, const double* T_WB_j, const double* T_BC, const double* lambda) const;

	/** Two unit tangents of a unit vector, smooth within either half-space of z (Duff et al., "Building an orthonormal basis, revisited").
	 */
	static Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& b);

   private:
	Eigen::Vector3d b_i_;
	Eigen::Vector3d b_j_;
	Eigen::Matrix<double, 2, 3> weighted_tangents_;  //!< A^T / sigma
};
}  // namespace viwo
