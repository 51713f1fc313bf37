#include "residuals/WheelResidual.h"

#include "residuals/BlockAlgebra.h"
#include "residuals/Whitening.h"

#include <viwo/core/So3.h>

namespace viwo
{
WheelResidual::WheelResidual(const WheelPreintegration& preintegration, const Pose3& T_BO, double covariance_inflation)
    : LocalCost(6, {BlockShape::pose(), BlockShape::pose(), BlockShape::euclidean(3)}),
      dp_(preintegration.dp()),
      dR_(preintegration.dR()),
      intrinsics_jacobian_(preintegration.intrinsicsJacobian()),
      intrinsics_(preintegration.intrinsics().k_left, preintegration.intrinsics().k_right, preintegration.intrinsics().track_m),
      T_BO_(T_BO),
      whiten_(whitening<6>(covariance_inflation * preintegration.covariance()))
{
}

bool WheelResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Pose3 T_i = poseFromBlock(x[0]);
	const Pose3 T_j = poseFromBlock(x[1]);
	const Vector6d correction = intrinsics_jacobian_ * (Eigen::Map<const Eigen::Vector3d>(x[2]) - intrinsics_);
	const Eigen::Vector3d theta = correction.tail<3>();
	const Eigen::Quaterniond dR = dR_ * so3::expQuaternion(theta);

	const Eigen::Quaterniond R_WOi = T_i.R * T_BO_.R;
	const Eigen::Quaterniond R_WOj = T_j.R * T_BO_.R;
	const Eigen::Matrix3d R_OB = T_BO_.R.conjugate().toRotationMatrix();
	const Eigen::Matrix3d R_OiW = R_WOi.conjugate().toRotationMatrix();
	const Eigen::Vector3d p_BiOj = T_i.R.conjugate() * (T_j * T_BO_.p - T_i.p);
	const Eigen::Vector3d r_phi = so3::log(Eigen::Quaterniond(dR.conjugate() * R_WOi.conjugate() * R_WOj));
	Vector6d r;
	r << R_OB * (p_BiOj - T_BO_.p) - dp_ - correction.head<3>(), r_phi;
	Eigen::Map<Vector6d>{residuals} = whiten_ * r;
	if (!jacobians) return true;

	using Matrix6d = Eigen::Matrix<double, 6, 6>;
	using PoseJacobian = Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;
	const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero();
	const Eigen::Matrix3d J_phi = so3::rightJacobianInverse(r_phi);
	if (jacobians[0])
	{
		Matrix6d J;
		J << -R_OiW, R_OB * so3::skew(p_BiOj), zero, -J_phi * (R_WOj.conjugate() * T_i.R).toRotationMatrix();
		PoseJacobian{jacobians[0]} = whiten_ * J;
	}
	if (jacobians[1])
	{
		Matrix6d J;
		J << R_OiW, -R_OiW * T_j.R.toRotationMatrix() * so3::skew(T_BO_.p), zero, J_phi * R_OB;
		PoseJacobian{jacobians[1]} = whiten_ * J;
	}
	if (jacobians[2])
	{
		Eigen::Matrix<double, 6, 3> J = -intrinsics_jacobian_;
		J.bottomRows<3>() = -J_phi * so3::exp(r_phi).transpose() * so3::rightJacobian(theta) * intrinsics_jacobian_.bottomRows<3>();
		Eigen::Map<Eigen::Matrix<double, 6, 3, Eigen::RowMajor>>{jacobians[2]} = whiten_ * J;
	}
	return true;
}
}  // namespace viwo
