#pragma once

#include "residuals/LocalCost.h"

#include <viwo/core/Pose3.h>

namespace viwo
{
/** Planar motion between two frames, in the form of Niu et al. Eq. 20 but in O and without Euler angles (kept for comparison with
 * PlaneResidual).
 *
 *      r = [ x and y of R_WOi^T R_WOj e_z / sigma_tilt,  z of R_WOi^T (p_WOj - p_WOi) / sigma_height ]
 *
 *  Blocks: pose T_WB_i, pose T_WB_j. Three residuals.
 */
class PairPlaneResidual : public LocalCost
{
   public:
	PairPlaneResidual(const Pose3& T_BO, double sigma_tilt_rad, double sigma_height_m);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	Pose3 T_BO_;
	Eigen::Vector3d weights_;
};
}  // namespace viwo
