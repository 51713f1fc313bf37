#pragma once

#include "residuals/LocalCost.h"

#include <Eigen/Core>
#include <memory>

namespace viwo
{
/** Another residual with one more euclidean block, on which it depends linearly: r = r_base(x) + J (theta - theta_0).
 *
 *  For what a preintegrated interval owes to small errors of its sensor, with J from integrating it anew; exact where theta is theta_0,
 *  to which intervals are integrated again.
 *  Blocks: those of the base, theta.
 */
class ExtendedResidual : public LocalCost
{
   public:
	/** @param J rows as those of the base's (whitened) residual. */
	ExtendedResidual(std::shared_ptr<LocalCost> base, const Eigen::MatrixXd& J, const Eigen::VectorXd& theta_0);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	std::shared_ptr<LocalCost> base_;
	Eigen::MatrixXd J_;
	Eigen::VectorXd theta_0_;
};
}  // namespace viwo
