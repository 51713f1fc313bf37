#include "residuals/ReferenceResidual.h"

#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>

namespace viwo
{
ReferenceResidual::ReferenceResidual(const Pose3& T_RO, const Eigen::Vector3d& v_O, const Eigen::Vector3d& w_O,
                                     const Vector6d& inverse_sigmas)
    : LocalCost(6, {BlockShape::pose(), BlockShape::pose(), BlockShape::pose(), BlockShape::euclidean(1)}),
      T_RO_(T_RO),
      weights_(inverse_sigmas)
{
	twist_ << v_O, w_O;
}

bool ReferenceResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Pose3 T_WB = poseFromBlock(x[0]), T_BO = poseFromBlock(x[1]), T_RW = poseFromBlock(x[2]);
	const Eigen::Matrix3d R_WB = T_WB.R.toRotationMatrix(), R_BO = T_BO.R.toRotationMatrix(), R_RW = T_RW.R.toRotationMatrix();
	const Eigen::Matrix3d R_OmR = T_RO_.R.conjugate().toRotationMatrix();
	const Eigen::Vector3d p_WO = T_WB * T_BO.p;
	const Eigen::Vector3d r_phi = so3::log(Eigen::Quaterniond(T_RO_.R.conjugate() * T_RW.R * T_WB.R * T_BO.R));
	Vector6d r;
	r << R_OmR * (T_RW * p_WO - T_RO_.p), r_phi;
	Eigen::Map<Vector6d>{residuals} = weights_.asDiagonal() * (r - twist_ * x[3][0]);
	if (!jacobians) return true;

	using Matrix6d = Eigen::Matrix<double, 6, 6>;
	using PoseJacobian = Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;
	const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero(), J_phi = so3::rightJacobianInverse(r_phi);
	const Eigen::Matrix3d R_OmW = R_OmR * R_RW, R_OmB = R_OmW * R_WB;
	Matrix6d J;
	if (jacobians[0])
	{
		J << R_OmW, -R_OmB * so3::skew(T_BO.p), zero, J_phi * R_BO.transpose();
		PoseJacobian{jacobians[0]} = weights_.asDiagonal() * J;
	}
	if (jacobians[1])
	{
		J << R_OmB, zero, zero, J_phi;
		PoseJacobian{jacobians[1]} = weights_.asDiagonal() * J;
	}
	if (jacobians[2])
	{
		J << R_OmR, -R_OmW * so3::skew(p_WO), zero, J_phi * (R_WB * R_BO).transpose();
		PoseJacobian{jacobians[2]} = weights_.asDiagonal() * J;
	}
	if (jacobians[3]) Eigen::Map<Vector6d>{jacobians[3]} = -(weights_.asDiagonal() * twist_);
	return true;
}
}  // namespace viwo
