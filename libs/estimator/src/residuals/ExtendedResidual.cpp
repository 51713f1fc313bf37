#include "residuals/ExtendedResidual.h"

namespace viwo
{
namespace
{
std::vector<BlockShape> withOneMore(std::vector<BlockShape> shapes, Eigen::Index size)
{
	shapes.push_back(BlockShape::euclidean(static_cast<int>(size)));
	return shapes;
}
}  // namespace

ExtendedResidual::ExtendedResidual(std::shared_ptr<LocalCost> base, const Eigen::MatrixXd& J, const Eigen::VectorXd& theta_0)
    : LocalCost(base->num_residuals(), withOneMore(base->shapes(), theta_0.size())), base_(std::move(base)), J_(J), theta_0_(theta_0)
{
}

bool ExtendedResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	if (!base_->evaluateLocal(x, residuals, jacobians)) return false;
	const size_t last = base_->shapes().size();
	const Eigen::Map<const Eigen::VectorXd> theta(x[last], theta_0_.size());
	Eigen::Map<Eigen::VectorXd>(residuals, J_.rows()) += J_ * (theta - theta_0_);
	if (jacobians && jacobians[last])
		Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(jacobians[last], J_.rows(), J_.cols()) = J_;
	return true;
}
}  // namespace viwo
