#include "residuals/ImuResidual.h"

#include "StateOrder.h"
#include "residuals/BlockAlgebra.h"
#include "residuals/Whitening.h"

#include <viwo/core/So3.h>

#include <utility>

namespace viwo
{
namespace
{
using S = StateOrder;
constexpr int motion_size = S::size - S::v;
constexpr size_t offset_block = 4;
constexpr int motion_v = 0, motion_b_a = S::b_a - S::v, motion_b_g = S::b_g - S::v;
using Vector3 = Eigen::Map<const Eigen::Vector3d>;
template <int N>
using Jacobian = Eigen::Matrix<double, S::size, N>;
template <int N>
using JacobianMap = Eigen::Map<Eigen::Matrix<double, S::size, N, Eigen::RowMajor>>;
}  // namespace

ImuResidual::ImuResidual(const ImuPreintegration& preintegration, double gravity_m_s2)
    : ImuResidual(preintegration, gravity_m_s2,
                  {BlockShape::pose(), BlockShape::euclidean(motion_size), BlockShape::pose(), BlockShape::euclidean(motion_size)}, {})
{
}

ImuResidual::ImuResidual(const ImuPreintegration& preintegration, double gravity_m_s2, const ImuTimeShift& shift)
    : ImuResidual(preintegration, gravity_m_s2,
                  {BlockShape::pose(), BlockShape::euclidean(motion_size), BlockShape::pose(), BlockShape::euclidean(motion_size),
                   BlockShape::euclidean(1)},
                  shift)
{
}

ImuResidual::ImuResidual(const ImuPreintegration& preintegration, double gravity_m_s2, std::vector<BlockShape> shapes,
                         const ImuTimeShift& shift)
    : LocalCost(S::size, std::move(shapes)),
      delta_(preintegration.delta()),
      bias_jacobian_(preintegration.biasJacobian()),
      b_a_(preintegration.b_a()),
      b_g_(preintegration.b_g()),
      dt_s_(preintegration.dt_s()),
      g_up_(0, 0, gravity_m_s2),
      shift_(shift),
      whiten_(whitening<S::size>(preintegration.covariance()))
{
}

ImuResidual::Terms ImuResidual::evaluate(double const* const* x, Vector15& r) const
{
	const Pose3 T_i = poseFromBlock(x[0]);
	const Pose3 T_j = poseFromBlock(x[2]);
	const Vector3 v_i(x[1] + motion_v), v_j(x[3] + motion_v);

	Eigen::Matrix<double, 6, 1> bias_change;
	bias_change << Vector3(x[1] + motion_b_a) - b_a_, Vector3(x[1] + motion_b_g) - b_g_;
	Eigen::Matrix<double, 9, 1> correction = bias_jacobian_ * bias_change;
	if (shapes().size() > offset_block) correction += shift_.per_s * (x[offset_block][0] - shift_.at_s);
	Terms t;
	t.theta = correction.segment<3>(S::phi);
	const Eigen::Quaterniond gamma = delta_.gamma * so3::expQuaternion(t.theta);

	t.R_BiW = T_i.R.conjugate().toRotationMatrix();
	t.R_BjBi = (T_j.R.conjugate() * T_i.R).toRotationMatrix();
	t.travel = t.R_BiW * (T_j.p - T_i.p - v_i * dt_s_ + 0.5 * dt_s_ * dt_s_ * g_up_);
	t.speed_change = t.R_BiW * (v_j - v_i + dt_s_ * g_up_);
	r.segment<3>(S::p) = t.travel - delta_.alpha - correction.segment<3>(S::p);
	r.segment<3>(S::phi) = so3::log(Eigen::Quaterniond(gamma.conjugate() * T_i.R.conjugate() * T_j.R));
	r.segment<3>(S::v) = t.speed_change - delta_.beta - correction.segment<3>(S::v);
	r.segment<3>(S::b_a) = Vector3(x[3] + motion_b_a) - Vector3(x[1] + motion_b_a);
	r.segment<3>(S::b_g) = Vector3(x[3] + motion_b_g) - Vector3(x[1] + motion_b_g);
	return t;
}

bool ImuResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	Vector15 r;
	const Terms t = evaluate(x, r);
	Eigen::Map<Vector15>{residuals} = whiten_ * r;
	if (!jacobians) return true;

	const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
	const Eigen::Vector3d r_phi = r.segment<3>(S::phi);
	const Eigen::Matrix3d J_phi = so3::rightJacobianInverse(r_phi);
	const Eigen::Matrix3d J_gamma = -J_phi * so3::exp(r_phi).transpose() * so3::rightJacobian(t.theta);  // of r_phi by theta
	if (jacobians[0])
	{
		Jacobian<6> J = Jacobian<6>::Zero();
		J.block<3, 3>(S::p, 0) = -t.R_BiW;
		J.block<3, 3>(S::p, 3) = so3::skew(t.travel);
		J.block<3, 3>(S::phi, 3) = -J_phi * t.R_BjBi;
		J.block<3, 3>(S::v, 3) = so3::skew(t.speed_change);
		JacobianMap<6>{jacobians[0]} = whiten_ * J;
	}
	if (jacobians[1])
	{
		Jacobian<motion_size> J = Jacobian<motion_size>::Zero();
		J.block<3, 3>(S::p, motion_v) = -dt_s_ * t.R_BiW;
		J.block<3, 3>(S::v, motion_v) = -t.R_BiW;
		J.block<9, 6>(0, motion_b_a) = -bias_jacobian_;
		J.block<3, 6>(S::phi, motion_b_a) = J_gamma * bias_jacobian_.middleRows<3>(S::phi);
		J.block<3, 3>(S::b_a, motion_b_a) = -I;
		J.block<3, 3>(S::b_g, motion_b_g) = -I;
		JacobianMap<motion_size>{jacobians[1]} = whiten_ * J;
	}
	if (jacobians[2])
	{
		Jacobian<6> J = Jacobian<6>::Zero();
		J.block<3, 3>(S::p, 0) = t.R_BiW;
		J.block<3, 3>(S::phi, 3) = J_phi;
		JacobianMap<6>{jacobians[2]} = whiten_ * J;
	}
	if (jacobians[3])
	{
		Jacobian<motion_size> J = Jacobian<motion_size>::Zero();
		J.block<3, 3>(S::v, motion_v) = t.R_BiW;
		J.block<3, 3>(S::b_a, motion_b_a) = I;
		J.block<3, 3>(S::b_g, motion_b_g) = I;
		JacobianMap<motion_size>{jacobians[3]} = whiten_ * J;
	}
	if (shapes().size() > offset_block && jacobians[offset_block])
	{
		Vector15 J = Vector15::Zero();
		J.head<9>() = -shift_.per_s;
		J.segment<3>(S::phi) = J_gamma * shift_.per_s.segment<3>(S::phi);
		Eigen::Map<Vector15>{jacobians[offset_block]} = whiten_ * J;
	}
	return true;
}
}  // namespace viwo
