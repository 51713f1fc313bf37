#include "residuals/StatePrior.h"

#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>

#include <Eigen/Cholesky>
#include <cmath>

namespace viwo
{
namespace
{
Eigen::MatrixXd finiteWeights(const Eigen::VectorXd& sigmas)
{
	Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(sigmas.array().isFinite().count(), sigmas.size());
	Eigen::Index row = 0;
	for (Eigen::Index i = 0; i < sigmas.size(); ++i)
		if (std::isfinite(sigmas[i])) weights(row++, i) = 1 / sigmas[i];
	return weights;
}
}  // namespace

StatePrior::StatePrior(const BlockShape& shape, const double* x0, const Eigen::VectorXd& sigmas)
    : LocalCost(static_cast<int>(sigmas.array().isFinite().count()), {shape}), x0_(x0, x0 + shape.ambient), weights_(finiteWeights(sigmas))
{
}

StatePrior::StatePrior(const BlockShape& shape, const double* x0, const Eigen::MatrixXd& weights, int rows)
    : LocalCost(rows, {shape}), x0_(x0, x0 + shape.ambient), weights_(weights)
{
}

std::shared_ptr<StatePrior> StatePrior::fromCovariance(const BlockShape& shape, const double* x0, const Eigen::MatrixXd& covariance)
{
	const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
	const Eigen::MatrixXd weights = llt.matrixL().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
	return std::shared_ptr<StatePrior>(new StatePrior(shape, x0, weights, static_cast<int>(weights.rows())));
}

bool StatePrior::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const BlockShape& shape = shapes()[0];
	Eigen::VectorXd error(shape.tangent);
	blockMinus(shape, x[0], x0_.data(), error.data());
	Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = weights_ * error;
	if (!jacobians || !jacobians[0]) return true;

	Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> J(jacobians[0], num_residuals(), shape.tangent);
	J = weights_;
	if (shape.kind == BlockKind::pose) J.rightCols<3>() = weights_.rightCols<3>() * so3::rightJacobianInverse(error.tail<3>());
	return true;
}
}  // namespace viwo
