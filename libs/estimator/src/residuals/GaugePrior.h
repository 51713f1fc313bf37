#pragma once

#include "residuals/LocalCost.h"

#include <viwo/core/Pose3.h>

namespace viwo
{
/** Fixes the four directions that no sensor observes: position of O, and yaw about W's z axis.
 *
 *      r = [ (p + R p_BO - p_WO0) / sigma_p,  e_z^T Log(R R0^T) / sigma_yaw ],   d Log(R R0^T) = J_l^-1 R dphi
 *
 *  Roll and pitch stay free: gravity knows them. It is O that is held, not B: W is where O was, and B swings about it by what the tilt is
 *  corrected. Block: pose T_WB. Four residuals.
 */
class GaugePrior : public LocalCost
{
   public:
	GaugePrior(const Pose3& T_WB0, const Eigen::Vector3d& p_BO, double sigma_position_m, double sigma_yaw_rad);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	Pose3 T_WB0_;
	Eigen::Vector3d p_BO_;
	double sigma_position_m_;
	double sigma_yaw_rad_;
};
}  // namespace viwo
