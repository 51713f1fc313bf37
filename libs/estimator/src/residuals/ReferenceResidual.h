#pragma once

#include "residuals/LocalCost.h"

#include <viwo/core/Pose3.h>

#include <Eigen/Core>

namespace viwo
{
/** A pose of the robot that another system has measured, in a frame R of its own and by a clock of its own:
 *
 *      r_p = R_RO_m^T (p_RW + R_RW (p_WB + R_WB p_BO) - p_RO_m) - v tau,   r_phi = Log(R_RO_m^T R_RW R_WB R_BO) - w tau
 *
 *  with the measured motion (v, w, in O's axes) at that time and the offset tau of the clock, s. A planar reference says nothing of
 *  height, roll and pitch. Blocks: pose T_WB, T_BO, T_RW, tau. Six residuals.
 */
class ReferenceResidual : public LocalCost
{
   public:
	/** @param inverse_sigmas of [p, phi]; 0: this row says nothing. */
	ReferenceResidual(const Pose3& T_RO, const Eigen::Vector3d& v_O, const Eigen::Vector3d& w_O,
	                  const Eigen::Matrix<double, 6, 1>& inverse_sigmas);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	Pose3 T_RO_;
	Eigen::Matrix<double, 6, 1> twist_, weights_;
};
}  // namespace viwo
