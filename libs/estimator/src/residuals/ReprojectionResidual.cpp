#include "residuals/ReprojectionResidual.h"

#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>

#include <cmath>

namespace viwo
{
namespace
{
using PoseJacobian = Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>>;
}

ReprojectionResidual::ReprojectionResidual(const Eigen::Vector3d& bearing_anchor, const Eigen::Vector3d& bearing_j, double sigma_rad)
    : LocalCost(2, {BlockShape::pose(), BlockShape::pose(), BlockShape::pose(), BlockShape::euclidean(1)}),
      b_i_(bearing_anchor.normalized()),
      b_j_(bearing_j.normalized()),
      weighted_tangents_(tangentBasis(b_j_).transpose() / sigma_rad)
{
}

bool ReprojectionResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Pose3 T_i = poseFromBlock(x[0]);
	const Pose3 T_j = poseFromBlock(x[1]);
	const Pose3 T_BC = poseFromBlock(x[2]);
	const double lambda = x[3][0];

	const Eigen::Matrix3d R_BiW = T_i.R.conjugate().toRotationMatrix();
	const Eigen::Matrix3d R_BjW = T_j.R.conjugate().toRotationMatrix();
	const Eigen::Matrix3d R_CB = T_BC.R.conjugate().toRotationMatrix();
	const Eigen::Vector3d x_Bi = R_CB.transpose() * b_i_ + lambda * T_BC.p;
	const Eigen::Vector3d x_Bj = R_BjW * (R_BiW.transpose() * x_Bi + lambda * (T_i.p - T_j.p));
	const Eigen::Vector3d f = R_CB * (x_Bj - lambda * T_BC.p);
	if (!(b_j_.dot(f) > 0)) return false;

	const double norm = f.norm();
	const Eigen::Vector3d u = f / norm;
	Eigen::Map<Eigen::Vector2d>{residuals} = weighted_tangents_ * u;
	if (!jacobians) return true;

	const Eigen::Matrix<double, 2, 3> dr_df = (weighted_tangents_ - weighted_tangents_ * u * u.transpose()) / norm;
	const Eigen::Matrix<double, 2, 3> dr_dxBj = dr_df * R_CB;
	const Eigen::Matrix<double, 2, 3> dr_dxW = dr_dxBj * R_BjW;
	const Eigen::Matrix<double, 2, 3> dr_dxBi = dr_dxW * R_BiW.transpose();
	if (jacobians[0]) PoseJacobian(jacobians[0]) << lambda * dr_dxW, -dr_dxBi * so3::skew(x_Bi);
	if (jacobians[1]) PoseJacobian(jacobians[1]) << -lambda * dr_dxW, dr_dxBj * so3::skew(x_Bj);
	if (jacobians[2])
		PoseJacobian(jacobians[2]) << lambda * (dr_dxBi - dr_dxBj), dr_df * so3::skew(f) - dr_dxBi * R_CB.transpose() * so3::skew(b_i_);
	if (jacobians[3]) Eigen::Map<Eigen::Vector2d>{jacobians[3]} = dr_dxBi * T_BC.p + dr_dxW * (T_i.p - T_j.p) - dr_dxBj * T_BC.p;
	return true;
}

bool ReprojectionResidual::valid(const double* T_WB_i, const double* T_WB_j, const double* T_BC, const double* lambda) const
{
	const double* x[] = {T_WB_i, T_WB_j, T_BC, lambda};
	double residuals[2];
	return lambda[0] > 0 && evaluateLocal(x, residuals, nullptr);
}

Eigen::Matrix<double, 3, 2> ReprojectionResidual::tangentBasis(const Eigen::Vector3d& b)
{
	const double sign = std::copysign(1.0, b.z());
	const double a = -1.0 / (sign + b.z());
	const double c = b.x() * b.y() * a;
	Eigen::Matrix<double, 3, 2> A;
	A.col(0) << 1 + sign * b.x() * b.x() * a, sign * c, -sign * b.x();
	A.col(1) << c, sign + b.y() * b.y() * a, -b.y();
	return A;
}
}  // namespace viwo
