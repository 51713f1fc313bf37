#include "residuals/WheelResidual.h"

#include "residuals/BlockAlgebra.h"
#include "residuals/Whitening.h"

#include <viwo/core/So3.h>

#include <utility>

namespace viwo
{
namespace
{
constexpr Eigen::Index forward_row = 0, yaw_row = 5;
constexpr size_t mounting_block = 3, camera_offset_block = 4, wheel_offset_block = 5;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using PoseJacobian = Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;
}  // namespace

WheelResidual::WheelResidual(const WheelPreintegration& preintegration, const Pose3& T_BO, double covariance_inflation)
    : WheelResidual(preintegration, T_BO, covariance_inflation, {BlockShape::pose(), BlockShape::pose(), BlockShape::euclidean(3)}, {})
{
}

WheelResidual::WheelResidual(const WheelPreintegration& preintegration, const WheelTimeShift& shift)
    : WheelResidual(preintegration, Pose3(), 1,
                    {BlockShape::pose(), BlockShape::pose(), BlockShape::euclidean(3), BlockShape::pose(), BlockShape::euclidean(1),
                     BlockShape::euclidean(1)},
                    shift)
{
}

WheelResidual::WheelResidual(const WheelPreintegration& preintegration, const Pose3& T_BO, double covariance_inflation,
                             std::vector<BlockShape> shapes, const WheelTimeShift& shift)
    : LocalCost(6, std::move(shapes)),
      dp_(preintegration.dp()),
      dR_(preintegration.dR()),
      intrinsics_jacobian_(preintegration.intrinsicsJacobian()),
      intrinsics_(preintegration.intrinsics().k_left, preintegration.intrinsics().k_right, preintegration.intrinsics().track_m),
      T_BO_(T_BO),
      shift_(shift),
      whiten_(whitening<6>(covariance_inflation * preintegration.covariance()))
{
}

WheelResidual::Units WheelResidual::units(const Eigen::Vector3d& intrinsics) const
{
	const double k = 0.5 * (intrinsics[0] + intrinsics[1]), k_0 = 0.5 * (intrinsics_[0] + intrinsics_[1]);
	const double forward = k_0 / k, yaw = forward * intrinsics[2] / intrinsics_[2];
	Units u;
	u.factor.setOnes();
	u.factor[forward_row] = forward;
	u.factor[yaw_row] = yaw;
	u.d_forward << -0.5 * forward / k, -0.5 * forward / k, 0;
	u.d_yaw << -0.5 * yaw / k, -0.5 * yaw / k, forward / intrinsics_[2];
	return u;
}

WheelResidual::Terms WheelResidual::evaluate(double const* const* x, double* residuals) const
{
	Terms t;
	t.T_i = poseFromBlock(x[0]);
	t.T_j = poseFromBlock(x[1]);
	t.T_BO = T_BO_;
	const Eigen::Map<const Eigen::Vector3d> intrinsics(x[2]);
	Vector6d correction = intrinsics_jacobian_ * (intrinsics - intrinsics_);
	if (shapes().size() > mounting_block)
	{
		t.T_BO = poseFromBlock(x[mounting_block]);
		correction += shift_.per_s * (x[camera_offset_block][0] - x[wheel_offset_block][0] - shift_.at_s);
	}
	t.theta = correction.tail<3>();
	const Eigen::Quaterniond dR = dR_ * so3::expQuaternion(t.theta);

	t.R_WOi = t.T_i.R * t.T_BO.R;
	t.R_WOj = t.T_j.R * t.T_BO.R;
	const Eigen::Matrix3d R_OB = t.T_BO.R.conjugate().toRotationMatrix();
	t.p_BiOj = t.T_i.R.conjugate() * (t.T_j * t.T_BO.p - t.T_i.p);
	t.lever = R_OB * (t.p_BiOj - t.T_BO.p);
	t.r_phi = so3::log(Eigen::Quaterniond(dR.conjugate() * t.R_WOi.conjugate() * t.R_WOj));
	t.r << t.lever - dp_ - correction.head<3>(), t.r_phi;
	t.units = units(intrinsics);
	t.whiten = whiten_ * t.units.factor.asDiagonal();
	Eigen::Map<Vector6d>{residuals} = t.whiten * t.r;
	return t;
}

bool WheelResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Terms t = evaluate(x, residuals);
	if (!jacobians) return true;

	const Eigen::Matrix3d R_OB = t.T_BO.R.conjugate().toRotationMatrix();
	const Eigen::Matrix3d R_OiW = t.R_WOi.conjugate().toRotationMatrix();
	const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero();
	const Eigen::Matrix3d J_phi = so3::rightJacobianInverse(t.r_phi);
	const Eigen::Matrix3d J_dR = -J_phi * so3::exp(t.r_phi).transpose() * so3::rightJacobian(t.theta);  // of r_phi by theta
	if (jacobians[0])
	{
		Matrix6d J;
		J << -R_OiW, R_OB * so3::skew(t.p_BiOj), zero, -J_phi * (t.R_WOj.conjugate() * t.T_i.R).toRotationMatrix();
		PoseJacobian{jacobians[0]} = t.whiten * J;
	}
	if (jacobians[1])
	{
		Matrix6d J;
		J << R_OiW, -R_OiW * t.T_j.R.toRotationMatrix() * so3::skew(t.T_BO.p), zero, J_phi * R_OB;
		PoseJacobian{jacobians[1]} = t.whiten * J;
	}
	if (jacobians[2])
	{
		Eigen::Matrix<double, 6, 3> J = -intrinsics_jacobian_;
		J.bottomRows<3>() = J_dR * intrinsics_jacobian_.bottomRows<3>();
		J.row(forward_row) += t.r[forward_row] / t.units.factor[forward_row] * t.units.d_forward;
		J.row(yaw_row) += t.r[yaw_row] / t.units.factor[yaw_row] * t.units.d_yaw;
		Eigen::Map<Eigen::Matrix<double, 6, 3, Eigen::RowMajor>>{jacobians[2]} = t.whiten * J;
	}
	if (shapes().size() > mounting_block) calibrationJacobians(t, J_phi, J_dR, jacobians);
	return true;
}

void WheelResidual::calibrationJacobians(const Terms& t, const Eigen::Matrix3d& J_phi, const Eigen::Matrix3d& J_dR,
                                         double** jacobians) const
{
	const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
	if (jacobians[mounting_block])
	{
		const Eigen::Matrix3d R_OB = t.T_BO.R.conjugate().toRotationMatrix();
		const Eigen::Matrix3d R_BiBj = (t.T_i.R.conjugate() * t.T_j.R).toRotationMatrix();
		const Eigen::Matrix3d R_OjOi = (t.R_WOj.conjugate() * t.R_WOi).toRotationMatrix();
		Matrix6d J;
		J << R_OB * (R_BiBj - I), so3::skew(t.lever), Eigen::Matrix3d::Zero(), J_phi * (I - R_OjOi);
		PoseJacobian{jacobians[mounting_block]} = t.whiten * J;
	}
	Vector6d J = -shift_.per_s;
	J.tail<3>() = J_dR * shift_.per_s.tail<3>();
	if (jacobians[camera_offset_block]) Eigen::Map<Vector6d>{jacobians[camera_offset_block]} = t.whiten * J;
	if (jacobians[wheel_offset_block]) Eigen::Map<Vector6d>{jacobians[wheel_offset_block]} = -(t.whiten * J);
}
}  // namespace viwo
