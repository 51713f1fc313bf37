#pragma once

#include "residuals/LocalCost.h"

#include <Eigen/Core>
#include <vector>

namespace viwo
{
/** What marginalisation leaves on the states that remain: r = r0 + J0 (x [-] x0), with the Jacobian J0 for good.
 *
 *  J0 was taken at x0, and the Jacobian at x is J0 as well: every factor on these states has to take its own at x0 too
 *  (LocalCost::freeze), or directions that are unobservable gain information that no sensor gave.
 *  Any number of blocks, in the order of `shapes`.
 */
class LinearPrior : public LocalCost
{
   public:
	/** @param x0 one linearisation point per block (ambient).
	 *  @param J0 rows x (sum of tangent sizes), whitened.
	 *  @param r0 the residual at x0. */
	LinearPrior(std::vector<BlockShape> shapes, std::vector<std::vector<double>> x0, Eigen::MatrixXd J0, Eigen::VectorXd r0);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;
	const double* linearizationPoint(int index) const override;

	/** x [-] x0 over all blocks. */
	Eigen::VectorXd deviation(double const* const* x) const;

   private:
	std::vector<std::vector<double>> x0_;
	Eigen::MatrixXd J0_;
	Eigen::VectorXd r0_;
};
}  // namespace viwo
