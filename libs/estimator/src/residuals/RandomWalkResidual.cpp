#include "residuals/RandomWalkResidual.h"

namespace viwo
{
RandomWalkResidual::RandomWalkResidual(const Eigen::VectorXd& sigmas)
    : LocalCost(static_cast<int>(sigmas.size()),
                {BlockShape::euclidean(static_cast<int>(sigmas.size())), BlockShape::euclidean(static_cast<int>(sigmas.size()))}),
      weights_(sigmas.cwiseInverse())
{
}

bool RandomWalkResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	using ConstVector = Eigen::Map<const Eigen::VectorXd>;
	using Square = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
	const Eigen::Index n = weights_.size();
	Eigen::Map<Eigen::VectorXd>(residuals, n) = weights_.cwiseProduct(ConstVector(x[1], n) - ConstVector(x[0], n));
	if (!jacobians) return true;
	if (jacobians[0]) Square(jacobians[0], n, n) = (-weights_).asDiagonal();
	if (jacobians[1]) Square(jacobians[1], n, n) = weights_.asDiagonal();
	return true;
}
}  // namespace viwo
