#include "residuals/ImuResidual.h"

#include "StateOrder.h"
#include "residuals/BlockAlgebra.h"
#include "residuals/Whitening.h"

#include <viwo/core/So3.h>

namespace viwo
{
namespace
{
using S = StateOrder;
constexpr int motion_size = S::size - S::v;
constexpr int motion_v = 0, motion_b_a = S::b_a - S::v, motion_b_g = S::b_g - S::v;
using Vector3 = Eigen::Map<const Eigen::Vector3d>;
template <int N>
using Jacobian = Eigen::Matrix<double, S::size, N>;
template <int N>
using JacobianMap = Eigen::Map<Eigen::Matrix<double, S::size, N, Eigen::RowMajor>>;
}  // namespace

ImuResidual::ImuResidual(const ImuPreintegration& preintegration, double gravity_m_s2)
    : LocalCost(S::size, {BlockShape::pose(), BlockShape::euclidean(motion_size), BlockShape::pose(), BlockShape::euclidean(motion_size)}),
      delta_(preintegration.delta()),
      bias_jacobian_(preintegration.biasJacobian()),
      b_a_(preintegration.b_a()),
      b_g_(preintegration.b_g()),
      dt_s_(preintegration.dt_s()),
      g_up_(0, 0, gravity_m_s2),
      whiten_(whitening<S::size>(preintegration.covariance()))
{
}

bool ImuResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Pose3 T_i = poseFromBlock(x[0]);
	const Pose3 T_j = poseFromBlock(x[2]);
	const Vector3 v_i(x[1] + motion_v), v_j(x[3] + motion_v);
	const double dt = dt_s_;

	Eigen::Matrix<double, 6, 1> bias_change;
	bias_change << Vector3(x[1] + motion_b_a) - b_a_, Vector3(x[1] + motion_b_g) - b_g_;
	const Eigen::Matrix<double, 9, 1> correction = bias_jacobian_ * bias_change;
	const Eigen::Vector3d theta = correction.segment<3>(S::phi);
	const Eigen::Quaterniond gamma = delta_.gamma * so3::expQuaternion(theta);

	const Eigen::Matrix3d R_BiW = T_i.R.conjugate().toRotationMatrix();
	const Eigen::Vector3d travel = R_BiW * (T_j.p - T_i.p - v_i * dt + 0.5 * dt * dt * g_up_);
	const Eigen::Vector3d speed_change = R_BiW * (v_j - v_i + dt * g_up_);
	const Eigen::Vector3d r_phi = so3::log(Eigen::Quaterniond(gamma.conjugate() * T_i.R.conjugate() * T_j.R));
	Eigen::Matrix<double, S::size, 1> r;
	r.segment<3>(S::p) = travel - delta_.alpha - correction.segment<3>(S::p);
	r.segment<3>(S::phi) = r_phi;
	r.segment<3>(S::v) = speed_change - delta_.beta - correction.segment<3>(S::v);
	r.segment<3>(S::b_a) = Vector3(x[3] + motion_b_a) - Vector3(x[1] + motion_b_a);
	r.segment<3>(S::b_g) = Vector3(x[3] + motion_b_g) - Vector3(x[1] + motion_b_g);
	Eigen::Map<Eigen::Matrix<double, S::size, 1>>{residuals} = whiten_ * r;
	if (!jacobians) return true;

	const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
	const Eigen::Matrix3d J_phi = so3::rightJacobianInverse(r_phi);
	if (jacobians[0])
	{
		Jacobian<6> J = Jacobian<6>::Zero();
		J.block<3, 3>(S::p, 0) = -R_BiW;
		J.block<3, 3>(S::p, 3) = so3::skew(travel);
		J.block<3, 3>(S::phi, 3) = -J_phi * (T_j.R.conjugate() * T_i.R).toRotationMatrix();
		J.block<3, 3>(S::v, 3) = so3::skew(speed_change);
		JacobianMap<6>{jacobians[0]} = whiten_ * J;
	}
	if (jacobians[1])
	{
		Jacobian<motion_size> J = Jacobian<motion_size>::Zero();
		J.block<3, 3>(S::p, motion_v) = -dt * R_BiW;
		J.block<3, 3>(S::v, motion_v) = -R_BiW;
		J.block<9, 6>(0, motion_b_a) = -bias_jacobian_;
		J.block<3, 6>(S::phi, motion_b_a) =
		    -J_phi * so3::exp(r_phi).transpose() * so3::rightJacobian(theta) * bias_jacobian_.middleRows<3>(S::phi);
		J.block<3, 3>(S::b_a, motion_b_a) = -I;
		J.block<3, 3>(S::b_g, motion_b_g) = -I;
		JacobianMap<motion_size>{jacobians[1]} = whiten_ * J;
	}
	if (jacobians[2])
	{
		Jacobian<6> J = Jacobian<6>::Zero();
		J.block<3, 3>(S::p, 0) = R_BiW;
		J.block<3, 3>(S::phi, 3) = J_phi;
		JacobianMap<6>{jacobians[2]} = whiten_ * J;
	}
	if (jacobians[3])
	{
		Jacobian<motion_size> J = Jacobian<motion_size>::Zero();
		J.block<3, 3>(S::v, motion_v) = R_BiW;
		J.block<3, 3>(S::b_a, motion_b_a) = I;
		J.block<3, 3>(S::b_g, motion_b_g) = I;
		JacobianMap<motion_size>{jacobians[3]} = whiten_ * J;
	}
	return true;
}
}  // namespace viwo
