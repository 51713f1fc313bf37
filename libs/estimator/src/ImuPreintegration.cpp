#include "ImuPreintegration.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

#include <cassert>

#include "RotatingIntegral.h"
#include "StateOrder.h"

namespace viwo
{
namespace
{
constexpr int kP = StateOrder::p, kPhi = StateOrder::phi, kV = StateOrder::v, kBias = StateOrder::b_a;
static_assert(kP == 0 && kPhi == 3 && kV == 6 && kBias == 9 && StateOrder::b_g == 12, "motion first, biases last and adjacent");

using Matrix9 = Eigen::Matrix<double, 9, 9>;

/** How an error at the start of a step or interval with this delta comes out at its end: the motion part of the transition. R: of the
 * start. */
Matrix9 motionTransition(const Eigen::Matrix3d& R, double dt_s, const Eigen::Vector3d& dp, const Eigen::Vector3d& dv,
                         const Eigen::Matrix3d& dR)
{
	Matrix9 F = Matrix9::Identity();
	F.block<3, 3>(kP, kPhi) = -R * so3::skew(dp);
	F.block<3, 3>(kP, kV).diagonal().setConstant(dt_s);
	F.block<3, 3>(kPhi, kPhi) = dR.transpose();
	F.block<3, 3>(kV, kPhi) = -R * so3::skew(dv);
	return F;
}
}  // namespace

ImuPreintegration::ImuPreintegration(const ImuNoise& noise, const Eigen::Vector3d& b_a, const Eigen::Vector3d& b_g)
    : noise_(noise), b_a_(b_a), b_g_(b_g)
{
}

void ImuPreintegration::integrate(const std::vector<ImuSample>& span)
{
	assert(span.size() >= 2);
	assert(samples_.empty() || samples_.back().t_ns == span.front().t_ns);
	samples_.insert(samples_.end(), span.begin() + (samples_.empty() ? 0 : 1), span.end());
	for (size_t i = 1; i < span.size(); ++i) integrateStep(span[i - 1], span[i]);
}

void ImuPreintegration::integrateStep(const ImuSample& from, const ImuSample& to)
{
	const double h = secondsBetween(from.t_ns, to.t_ns);
	const Eigen::Vector3d a = 0.5 * (from.acc_m_s2 + to.acc_m_s2) - b_a_;
	const Eigen::Vector3d turn = (0.5 * (from.gyro_rad_s + to.gyro_rad_s) - b_g_) * h;

	const Eigen::Matrix3d R = delta_.gamma.toRotationMatrix();
	const Eigen::Quaterniond dR = so3::expQuaternion(turn);
	const Eigen::Matrix3d G1 = rotating::gamma(1, turn), G2 = rotating::gamma(2, turn);
	const Eigen::Vector3d dv = G1 * a * h, dp = G2 * a * h * h;

	// M: what the step's end owes to the biases within the step (the true signal is the measured one minus bias).
	BiasJacobian M;
	M.block<3, 3>(kP, 0) = -h * h * R * G2;
	M.block<3, 3>(kP, 3) = -h * h * h * R * rotating::gammaTimesVectorDerivative(2, turn, a);
	M.block<3, 3>(kPhi, 0).setZero();
	M.block<3, 3>(kPhi, 3) = -h * so3::rightJacobian(turn);
	M.block<3, 3>(kV, 0) = -h * R * G1;
	M.block<3, 3>(kV, 3) = -h * h * R * rotating::gammaTimesVectorDerivative(1, turn, a);
	propagateErrors(h, motionTransition(R, h, dp, dv, dR.toRotationMatrix()), M);

	delta_.alpha += delta_.beta * h + R * dp;
	delta_.beta += R * dv;
	delta_.gamma = (delta_.gamma * dR).normalized();
	dt_s_ += h;
}

/** x+ = F x + M (bias + walk/2 + noise), bias+ = bias + walk. */
void ImuPreintegration::propagateErrors(double dt_s, const Matrix9& F, const BiasJacobian& M)
{
	Eigen::Matrix<double, 6, 1> white, walk;
	white.head<3>().setConstant(square(noise_.acc_noise_m_s2_sqrtHz) / dt_s);
	white.tail<3>().setConstant(square(noise_.gyro_noise_rad_s_sqrtHz) / dt_s);
	walk.head<3>().setConstant(square(noise_.acc_walk_m_s3_sqrtHz) * dt_s);
	walk.tail<3>().setConstant(square(noise_.gyro_walk_rad_s2_sqrtHz) * dt_s);

	const Matrix9 P = covariance_.topLeftCorner<9, 9>();
	const BiasJacobian C = covariance_.topRightCorner<9, 6>();
	Eigen::Matrix<double, 6, 6> bias = covariance_.bottomRightCorner<6, 6>();  // diagonal

	const Matrix9 FCM = F * C * M.transpose();
	const Eigen::Matrix<double, 6, 1> within = bias.diagonal() + 0.25 * walk + white;
	covariance_.topLeftCorner<9, 9>() = F * P * F.transpose() + FCM + FCM.transpose() + M * within.asDiagonal() * M.transpose();
	const BiasJacobian cross = F * C + M * (bias.diagonal() + 0.5 * walk).asDiagonal();
	covariance_.topRightCorner<9, 6>() = cross;
	covariance_.bottomLeftCorner<6, 9>() = cross.transpose();
	covariance_.bottomRightCorner<6, 6>().diagonal() += walk;

	// White noise integrated twice has more in it than its mean over the step tells: sigma^2 h^3 (1/3 - 1/4), apart from the velocity's. It
	// keeps the covariance of an interval of a single step invertible.
	covariance_.diagonal().segment<3>(kP).array() += square(noise_.acc_noise_m_s2_sqrtHz) * dt_s * dt_s * dt_s / 12;

	bias_jacobian_ = F * bias_jacobian_ + M;
}

void ImuPreintegration::append(const ImuPreintegration& next)
{
	assert(b_a_ == next.b_a_ && b_g_ == next.b_g_);
	assert(samples_.empty() || next.samples_.empty() || t_end_ns() == next.t_begin_ns());
	if (next.samples_.empty()) return;
	const Eigen::Matrix3d R = delta_.gamma.toRotationMatrix();
	const ImuDelta& d = next.delta_;

	Matrix9 G = Matrix9::Identity();
	G.block<3, 3>(kP, kP) = R;
	G.block<3, 3>(kV, kV) = R;
	Covariance F_all = Covariance::Identity(), G_all = Covariance::Identity();
	F_all.topLeftCorner<9, 9>() = motionTransition(R, next.dt_s_, d.alpha, d.beta, d.gamma.toRotationMatrix());
	F_all.topRightCorner<9, 6>() = G * next.bias_jacobian_;
	G_all.topLeftCorner<9, 9>() = G;
	covariance_ = (F_all * covariance_ * F_all.transpose() + G_all * next.covariance_ * G_all.transpose()).eval();
	bias_jacobian_ = (F_all.topLeftCorner<9, 9>() * bias_jacobian_ + F_all.topRightCorner<9, 6>()).eval();

	delta_.alpha += delta_.beta * next.dt_s_ + R * d.alpha;
	delta_.beta += R * d.beta;
	delta_.gamma = (delta_.gamma * d.gamma).normalized();
	dt_s_ += next.dt_s_;
	samples_.insert(samples_.end(), next.samples_.begin() + (samples_.empty() ? 0 : 1), next.samples_.end());
}

void ImuPreintegration::reset()
{
	dt_s_ = 0;
	delta_ = {};
	bias_jacobian_.setZero();
	covariance_.setZero();
}

void ImuPreintegration::repropagate(const Eigen::Vector3d& b_a, const Eigen::Vector3d& b_g)
{
	b_a_ = b_a;
	b_g_ = b_g;
	reset();
	for (size_t i = 1; i < samples_.size(); ++i) integrateStep(samples_[i - 1], samples_[i]);
}

ImuDelta ImuPreintegration::corrected(const Eigen::Vector3d& b_a, const Eigen::Vector3d& b_g) const
{
	Eigen::Matrix<double, 6, 1> change;
	change << b_a - b_a_, b_g - b_g_;
	const Eigen::Matrix<double, 9, 1> d = bias_jacobian_ * change;
	return {delta_.alpha + d.segment<3>(kP), delta_.beta + d.segment<3>(kV),
	        (delta_.gamma * so3::expQuaternion(d.segment<3>(kPhi))).normalized()};
}
}  // namespace viwo
