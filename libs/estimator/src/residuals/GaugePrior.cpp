#include "residuals/GaugePrior.h"

#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>

namespace viwo
{
GaugePrior::GaugePrior(const Pose3& T_WB0, const Eigen::Vector3d& p_BO, double sigma_position_m, double sigma_yaw_rad)
    : LocalCost(4, {BlockShape::pose()}), T_WB0_(T_WB0), p_BO_(p_BO), sigma_position_m_(sigma_position_m), sigma_yaw_rad_(sigma_yaw_rad)
{
}

bool GaugePrior::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Pose3 T_WB = poseFromBlock(x[0]);
	const Eigen::Vector3d turn = so3::log(Eigen::Quaterniond(T_WB.R * T_WB0_.R.conjugate()));
	Eigen::Map<Eigen::Vector4d>{residuals} << (T_WB * p_BO_ - T_WB0_ * p_BO_) / sigma_position_m_, turn.z() / sigma_yaw_rad_;
	if (!jacobians || !jacobians[0]) return true;

	Eigen::Map<Eigen::Matrix<double, 4, 6, Eigen::RowMajor>> J(jacobians[0]);
	J.setZero();
	J.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / sigma_position_m_;
	J.block<3, 3>(0, 3) = -T_WB.R.toRotationMatrix() * so3::skew(p_BO_) / sigma_position_m_;
	J.block<1, 3>(3, 3) = so3::leftJacobianInverse(turn).row(2) * T_WB.R.toRotationMatrix() / sigma_yaw_rad_;
	return true;
}
}  // namespace viwo
