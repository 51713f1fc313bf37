#pragma once

#include "residuals/LocalCost.h"

#include <viwo/core/Pose3.h>

namespace viwo
{
/** The robot drives on a plane that is itself estimated (in place of Niu et al. Eq. 20, which ties frames to each other).
 *
 *      n   = Exp([tilt_x, tilt_y, 0]) e_z             plane: n^T x_W = height,   dn = -Exp(tilt) [e_z]_x J_r(tilt) dtilt
 *      R_WO = R_WB R_BO,  p_WO = p_WB + R_WB p_BO
 *      r   = [ x and y of R_WO^T n / sigma_tilt,  (n^T p_WO - height) / sigma_height ]
 *
 *  A change (dp, dphi) of T_BO, where that is a state too, moves the first two by [R_WO^T n]_x dphi and the third by n^T R_WB dp.
 *
 *  Blocks: pose T_WB, plane (tilt_x, tilt_y in rad, height in m), and T_BO unless it is given. Three residuals.
 */
class PlaneResidual : public LocalCost
{
   public:
	PlaneResidual(const Pose3& T_BO, double sigma_tilt_rad, double sigma_height_m);
	/** With the block of T_BO. */
	PlaneResidual(double sigma_tilt_rad, double sigma_height_m);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	Pose3 T_BO_;
	Eigen::Vector3d weights_;
};
}  // namespace viwo
