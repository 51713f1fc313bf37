#include "residuals/LocalCost.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace viwo
{
namespace
{
/** Doubles for one evaluation: on the stack for the usual residual, on the heap for a prior. */
class Scratch
{
   public:
	explicit Scratch(size_t size)
	{
		if (size > stack_.size()) heap_.resize(size);
		next_ = heap_.empty() ? stack_.data() : heap_.data();
	}
	double* take(size_t size) { return std::exchange(next_, next_ + size); }

   private:
	std::array<double, 768> stack_;
	std::vector<double> heap_;
	double* next_;
};

/** J_ambient = J_local * MinusJacobian(x) of PoseManifold, whose position part is the identity. */
void liftPose(int rows, const double* x, const double* local, double* ambient)
{
	const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> J(local, rows, 6);
	Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> lifted(ambient, rows, 7);
	const Eigen::Vector3d v(x[3], x[4], x[5]);
	for (int row = 0; row < rows; ++row)
	{
		const Eigen::Vector3d a = 2.0 * J.block<1, 3>(row, 3).transpose();
		lifted.block<1, 3>(row, 0) = J.block<1, 3>(row, 0);
		lifted.block<1, 3>(row, 3) = (x[6] * a - a.cross(v)).transpose();
		lifted(row, 6) = -a.dot(v);
	}
}
}  // namespace

LocalCost::LocalCost(int num_residuals, std::vector<BlockShape> shapes) : shapes_(std::move(shapes)), frozen_(shapes_.size())
{
	set_num_residuals(num_residuals);
	for (const BlockShape& shape : shapes_) mutable_parameter_block_sizes()->push_back(shape.ambient);
}

void LocalCost::freeze(int index, const double* x0)
{
	const auto i = static_cast<size_t>(index);
	frozen_[i].clear();
	if (x0) frozen_[i].assign(x0, x0 + shapes_[i].ambient);
}

const double* LocalCost::linearizationPoint(int index) const
{
	const auto& x0 = frozen_[static_cast<size_t>(index)];
	return x0.empty() ? nullptr : x0.data();
}

bool LocalCost::linearize(double const* const* x, double* residuals, double** local_jacobians) const
{
	const bool frozen = std::any_of(frozen_.begin(), frozen_.end(), [](const auto& x0) { return !x0.empty(); });
	if (!frozen || !local_jacobians) return evaluateLocal(x, residuals, local_jacobians);

	std::vector<const double*> x0(shapes_.size());
	for (size_t i = 0; i < x0.size(); ++i) x0[i] = frozen_[i].empty() ? x[i] : frozen_[i].data();
	Scratch residuals_at_x0(static_cast<size_t>(num_residuals()));
	return evaluateLocal(x0.data(), residuals_at_x0.take(static_cast<size_t>(num_residuals())), local_jacobians) &&
	       evaluateLocal(x, residuals, nullptr);
}

bool LocalCost::Evaluate(double const* const* x, double* residuals, double** jacobians) const
{
	const auto rows = static_cast<size_t>(num_residuals());
	size_t scratch_size = 0;
	if (jacobians)
		for (size_t i = 0; i < shapes_.size(); ++i)
			if (jacobians[i] && shapes_[i].kind == BlockKind::pose) scratch_size += rows * 6;
	Scratch scratch(scratch_size);
	std::vector<double*> local(jacobians ? shapes_.size() : 0, nullptr);
	for (size_t i = 0; i < local.size(); ++i)
		if (jacobians[i]) local[i] = shapes_[i].kind == BlockKind::pose ? scratch.take(rows * 6) : jacobians[i];

	const bool valid = linearize(x, residuals, jacobians ? local.data() : nullptr);
	if (!valid) std::fill_n(residuals, rows, kInvalidResidual);
	for (size_t i = 0; i < local.size(); ++i)
	{
		if (!jacobians[i]) continue;
		if (!valid)
			std::fill_n(jacobians[i], rows * static_cast<size_t>(shapes_[i].ambient), 0.0);
		else if (local[i] != jacobians[i])
			liftPose(num_residuals(), x[i], local[i], jacobians[i]);
	}
	return true;
}
}  // namespace viwo
