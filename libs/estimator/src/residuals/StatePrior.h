#pragma once

#include "residuals/LocalCost.h"

#include <Eigen/Core>
#include <vector>

namespace viwo
{
/** A prior with independent sigmas on one block of any kind: r = (x [-] x0) / sigma, a row for each finite sigma.
 *  For a pose, x [-] x0 = [p - p0, Log(R0^T R)], with derivative J_r^-1 in the rotation.
 */
class StatePrior : public LocalCost
{
   public:
	/** @param x0 the block's expected value (ambient size of `shape`).
	 *  @param sigmas one per tangent coordinate; an infinite one drops its row. At least one is finite. */
	StatePrior(const BlockShape& shape, const double* x0, const Eigen::VectorXd& sigmas);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	std::vector<double> x0_;
	Eigen::MatrixXd weights_;  //!< rows of diag(1 / sigma) with finite sigma
};
}  // namespace viwo
