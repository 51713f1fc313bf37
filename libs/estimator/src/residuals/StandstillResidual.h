#pragma once

#include "residuals/LocalCost.h"

#include <Eigen/Core>

namespace viwo
{
/** The robot stands: r = v_WB / sigma_v. Block: motion (v, b_a, b_g). Three residuals. */
class StandstillResidual : public LocalCost
{
   public:
	explicit StandstillResidual(double sigma_v_m_s);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	double sigma_v_m_s_;
};
}  // namespace viwo
