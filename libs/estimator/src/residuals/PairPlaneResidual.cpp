#include "residuals/PairPlaneResidual.h"

#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>

namespace viwo
{
PairPlaneResidual::PairPlaneResidual(const Pose3& T_BO, double sigma_tilt_rad, double sigma_height_m)
    : LocalCost(3, {BlockShape::pose(), BlockShape::pose()}),
      T_BO_(T_BO),
      weights_(1 / sigma_tilt_rad, 1 / sigma_tilt_rad, 1 / sigma_height_m)
{
}

bool PairPlaneResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Pose3 T_i = poseFromBlock(x[0]);
	const Pose3 T_j = poseFromBlock(x[1]);
	const Eigen::Matrix3d R_OB = T_BO_.R.conjugate().toRotationMatrix();
	const Eigen::Matrix3d R_BiW = T_i.R.conjugate().toRotationMatrix();
	const Eigen::Matrix3d R_BiBj = R_BiW * T_j.R.toRotationMatrix();
	const Eigen::Vector3d up_Bj = R_OB.row(2);  // z axis of O, in B_j's axes
	const Eigen::Vector3d up_Bi = R_BiBj * up_Bj;
	const Eigen::Vector3d p_BiOj = R_BiW * (T_j * T_BO_.p - T_i.p);

	Eigen::Map<Eigen::Vector3d> r(residuals);
	r << (R_OB * up_Bi).head<2>(), R_OB.row(2).dot(p_BiOj - T_BO_.p);
	r.array() *= weights_.array();
	if (!jacobians) return true;

	using PoseJacobian = Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>>;
	if (jacobians[0])
	{
		PoseJacobian J(jacobians[0]);
		J.setZero();
		J.block<2, 3>(0, 3) = (R_OB * so3::skew(up_Bi)).topRows<2>();
		J.row(2) << -R_OB.row(2) * R_BiW, R_OB.row(2) * so3::skew(p_BiOj);
		J = weights_.asDiagonal() * J.eval();
	}
	if (jacobians[1])
	{
		PoseJacobian J(jacobians[1]);
		J.setZero();
		J.block<2, 3>(0, 3) = -(R_OB * R_BiBj * so3::skew(up_Bj)).topRows<2>();
		J.row(2) << R_OB.row(2) * R_BiW, -R_OB.row(2) * R_BiBj * so3::skew(T_BO_.p);
		J = weights_.asDiagonal() * J.eval();
	}
	return true;
}
}  // namespace viwo
