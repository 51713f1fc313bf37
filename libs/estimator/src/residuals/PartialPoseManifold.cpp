#include "residuals/PartialPoseManifold.h"

#include "residuals/PoseManifold.h"

#include <Eigen/Core>

namespace viwo
{
namespace
{
template <int Rows, int Columns>
using RowMajor = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;
}  // namespace

PartialPoseManifold::PartialPoseManifold(const std::array<bool, 6>& is_free)
{
	for (int i = 0; i < 6; ++i)
		if (is_free[static_cast<size_t>(i)]) coordinates_.push_back(i);
}

bool PartialPoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const
{
	double whole[6] = {};
	for (size_t i = 0; i < coordinates_.size(); ++i) whole[coordinates_[i]] = delta[i];
	return PoseManifold().Plus(x, whole, x_plus_delta);
}

bool PartialPoseManifold::PlusJacobian(const double* x, double* jacobian) const
{
	RowMajor<7, 6> whole;
	PoseManifold().PlusJacobian(x, whole.data());
	Eigen::Map<RowMajor<7, Eigen::Dynamic>> J(jacobian, 7, TangentSize());
	for (int i = 0; i < TangentSize(); ++i) J.col(i) = whole.col(coordinates_[static_cast<size_t>(i)]);
	return true;
}

bool PartialPoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const
{
	double whole[6];
	PoseManifold().Minus(y, x, whole);
	for (size_t i = 0; i < coordinates_.size(); ++i) y_minus_x[i] = whole[coordinates_[i]];
	return true;
}

bool PartialPoseManifold::MinusJacobian(const double* x, double* jacobian) const
{
	RowMajor<6, 7> whole;
	PoseManifold().MinusJacobian(x, whole.data());
	Eigen::Map<RowMajor<Eigen::Dynamic, 7>> J(jacobian, TangentSize(), 7);
	for (int i = 0; i < TangentSize(); ++i) J.row(i) = whole.row(coordinates_[static_cast<size_t>(i)]);
	return true;
}
}  // namespace viwo
