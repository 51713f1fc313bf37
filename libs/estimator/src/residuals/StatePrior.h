#pragma once

#include "residuals/LocalCost.h"

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace viwo
{
/** A prior on one block of any kind: r = L^-1 (x [-] x0) with covariance L L^T, or with independent sigmas a row for each finite one.
 *  For a pose, x [-] x0 = [p - p0, Log(R0^T R)], with derivative J_r^-1 in the rotation.
 */
class StatePrior : public LocalCost
{
   public:
	/** @param x0 the block's expected value (ambient size of `shape`).
	 *  @param sigmas one per tangent coordinate; an infinite one drops its row. At least one is finite. */
	StatePrior(const BlockShape& shape, const double* x0, const Eigen::VectorXd& sigmas);

	/** @param covariance of x [-] x0, positive definite. */
	static std::shared_ptr<StatePrior> fromCovariance(const BlockShape& shape, const double* x0, const Eigen::MatrixXd& covariance);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	StatePrior(const BlockShape& shape, const double* x0, const Eigen::MatrixXd& weights, int rows);

	std::vector<double> x0_;
	Eigen::MatrixXd weights_;  //!< L^-1; of independent sigmas, rows of diag(1 / sigma) with finite sigma
};
}  // namespace viwo
