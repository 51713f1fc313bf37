#pragma once

#include "residuals/LocalCost.h"

#include <Eigen/Core>

namespace viwo
{
/** A quantity that drifts: r = (b - a) / sigma. Blocks: euclidean a (earlier), euclidean b (later), of the same size. */
class RandomWalkResidual : public LocalCost
{
   public:
	/** @param sigmas standard deviations of the drift between a and b; their number is the size of both blocks. */
	explicit RandomWalkResidual(const Eigen::VectorXd& sigmas);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

   private:
	Eigen::VectorXd weights_;
};
}  // namespace viwo
