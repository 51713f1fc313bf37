#include "residuals/LinearPrior.h"

#include "residuals/BlockAlgebra.h"

namespace viwo
{
LinearPrior::LinearPrior(std::vector<BlockShape> shapes, std::vector<std::vector<double>> x0, Eigen::MatrixXd J0, Eigen::VectorXd r0)
    : LocalCost(static_cast<int>(r0.size()), std::move(shapes)), x0_(std::move(x0)), J0_(std::move(J0)), r0_(std::move(r0))
{
}

const double* LinearPrior::linearizationPoint(int index) const
{
	return x0_[static_cast<size_t>(index)].data();
}

Eigen::VectorXd LinearPrior::deviation(double const* const* x) const
{
	Eigen::VectorXd dx(J0_.cols());
	Eigen::Index column = 0;
	for (size_t i = 0; i < x0_.size(); ++i)
	{
		blockMinus(shapes()[i], x[i], x0_[i].data(), dx.data() + column);
		column += shapes()[i].tangent;
	}
	return dx;
}

bool LinearPrior::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = r0_ + J0_ * deviation(x);
	if (!jacobians) return true;
	Eigen::Index column = 0;
	for (size_t i = 0; i < x0_.size(); ++i)
	{
		const int n = shapes()[i].tangent;
		using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
		if (jacobians[i]) Eigen::Map<Jacobian>(jacobians[i], num_residuals(), n) = J0_.middleCols(column, n);
		column += n;
	}
	return true;
}
}  // namespace viwo
