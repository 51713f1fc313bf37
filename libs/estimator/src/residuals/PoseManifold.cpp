#include "residuals/PoseManifold.h"

#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>

namespace viwo
{
bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const
{
	blockPlus(BlockShape::pose(), x, delta, x_plus_delta);
	return true;
}

bool PoseManifold::PlusJacobian(const double* x, double* jacobian) const
{
	Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
	const Eigen::Vector3d v(x[3], x[4], x[5]);
	J.setZero();
	J.topLeftCorner<3, 3>().setIdentity();
	J.block<3, 3>(3, 3) = 0.5 * (x[6] * Eigen::Matrix3d::Identity() + so3::skew(v));
	J.block<1, 3>(6, 3) = -0.5 * v.transpose();
	return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const
{
	blockMinus(BlockShape::pose(), y, x, y_minus_x);
	return true;
}

bool PoseManifold::MinusJacobian(const double* x, double* jacobian) const
{
	Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
	const Eigen::Vector3d v(x[3], x[4], x[5]);
	J.setZero();
	J.topLeftCorner<3, 3>().setIdentity();
	J.block<3, 3>(3, 3) = 2.0 * (x[6] * Eigen::Matrix3d::Identity() - so3::skew(v));
	J.block<3, 1>(3, 6) = -2.0 * v;
	return true;
}
}  // namespace viwo
