#pragma once

#include "residuals/LocalCost.h"

#include <Eigen/Core>

namespace viwo
{
/** The robot stands: r = v_WB / sigma_v, and with a mean gyroscope reading of the time also (gyro_mean - b_g) / sigma_g.
 *  Block: motion (v, b_a, b_g). Three or six residuals.
 */
class StandstillResidual : public LocalCost
{
   public:
	explicit StandstillResidual(double sigma_v_m_s);
	/** @param gyro_mean_rad_s mean reading in B over the standstill, in rad/s. */
	StandstillResidual(double sigma_v_m_s, const Eigen::Vector3d& gyro_mean_rad_s, double sigma_gyro_rad_s);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	double sigma_v_m_s_;
	Eigen::Vector3d gyro_mean_rad_s_ = Eigen::Vector3d::Zero();
	double sigma_gyro_rad_s_ = 1;
};
}  // namespace viwo
