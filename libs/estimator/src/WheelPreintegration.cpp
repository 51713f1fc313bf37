#include "WheelPreintegration.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>

#include <cassert>
#include <cmath>

#include "RotatingIntegral.h"

namespace viwo
{
namespace
{
constexpr int kP = 0, kPhi = 3;
// A twist error is [velocity of O, angular rate], in O's axes.
constexpr int kForward = 0, kLateral = 1, kVertical = 2, kRoll = 3, kPitch = 4, kYaw = 5;

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/** How an error at the start of a step or interval with this delta comes out at its end (Niu et al. Eq. 7: A). R: of the start. */
Matrix6 transition(const Eigen::Matrix3d& R, const Eigen::Vector3d& dp, const Eigen::Matrix3d& dR)
{
	Matrix6 A = Matrix6::Identity();
	A.block<3, 3>(kP, kPhi) = -R * so3::skew(dp);
	A.block<3, 3>(kPhi, kPhi) = dR.transpose();
	return A;
}
}  // namespace

WheelPreintegration::WheelPreintegration(const WheelNoise& noise, const WheelIntrinsics& at) : noise_(noise), intrinsics_(at) {}

void WheelPreintegration::integrate(const WheelSegment& segment)
{
	if (segment.dt_s <= 0) return;
	segments_.push_back(segment);
	integrateStep(segment);
}

void WheelPreintegration::integrateStep(const WheelSegment& segment)
{
	const double h = segment.dt_s;
	const WheelTwist twist = twistOf(WheelSample{0, segment.v_left_m_s, segment.v_right_m_s}, intrinsics_);
	const Eigen::Vector3d v(twist.v_m_s, 0, 0), turn(0, 0, twist.w_rad_s * h);

	const Eigen::Matrix3d R = delta_.R.toRotationMatrix();
	const Eigen::Quaterniond dR = so3::expQuaternion(turn);
	const Eigen::Matrix3d G1 = rotating::gamma(1, turn);
	const Eigen::Vector3d u = G1 * v * h;

	// B: of the step's end with respect to its twist. A turn rate moves the end of the arc too.
	Matrix6 B = Matrix6::Zero();
	B.block<3, 3>(kP, 0) = h * R * G1;
	B.block<3, 3>(kP, 3) = h * h * R * rotating::gammaTimesVectorDerivative(1, turn, v);
	B.block<3, 3>(kPhi, 3) = h * so3::rightJacobian(turn);

	// Niu et al. Eq. 7-8, with the rotation before the step.
	const Matrix6 A = transition(R, u, dR.toRotationMatrix());
	covariance_ = (A * covariance_ * A.transpose() + B * twistNoise(segment) * B.transpose()).eval();
	intrinsics_jacobian_ = (A * intrinsics_jacobian_ + B * twistJacobian(segment)).eval();

	delta_.p += R * u;
	delta_.R = (delta_.R * dR).normalized();
	dt_s_ += h;
	distance_m_ += std::abs(twist.v_m_s) * h;
}

/** Covariance of the mean twist over the segment: both wheels' noise (Niu et al. Eq. 2) and the floors. */
Matrix6 WheelPreintegration::twistNoise(const WheelSegment& segment) const
{
	const double half_l = 0.5 * intrinsics_.k_left, half_r = 0.5 * intrinsics_.k_right;
	const double yaw_l = -intrinsics_.k_left / intrinsics_.track_m, yaw_r = intrinsics_.k_right / intrinsics_.track_m;
	const double var_l = square(noise_.s0_m_s_sqrtHz) + square(noise_.k_sqrtHz * segment.v_left_m_s);
	const double var_r = square(noise_.s0_m_s_sqrtHz) + square(noise_.k_sqrtHz * segment.v_right_m_s);

	Matrix6 Q = Matrix6::Zero();
	Q(kForward, kForward) = square(half_l) * var_l + square(half_r) * var_r;
	Q(kYaw, kYaw) = square(yaw_l) * var_l + square(yaw_r) * var_r;
	Q(kForward, kYaw) = Q(kYaw, kForward) = half_l * yaw_l * var_l + half_r * yaw_r * var_r;
	Q(kLateral, kLateral) = square(noise_.lateral_m_s_sqrtHz);
	Q(kVertical, kVertical) = square(noise_.vertical_m_s_sqrtHz);
	Q(kRoll, kRoll) = Q(kPitch, kPitch) = square(noise_.tilt_rad_s_sqrtHz);
	return segment.variance_scale / segment.dt_s * Q;
}

/** Of the segment's twist with respect to (k_left, k_right, track_m). */
WheelPreintegration::IntrinsicsJacobian WheelPreintegration::twistJacobian(const WheelSegment& segment) const
{
	const double l = intrinsics_.track_m;
	const double w = (intrinsics_.k_right * segment.v_right_m_s - intrinsics_.k_left * segment.v_left_m_s) / l;
	IntrinsicsJacobian J = IntrinsicsJacobian::Zero();
	J.row(kForward) << 0.5 * segment.v_left_m_s, 0.5 * segment.v_right_m_s, 0;
	J.row(kYaw) << -segment.v_left_m_s / l, segment.v_right_m_s / l, -w / l;
	return J;
}

void WheelPreintegration::append(const WheelPreintegration& next)
{
	assert(intrinsics_.k_left == next.intrinsics_.k_left && intrinsics_.k_right == next.intrinsics_.k_right &&
	       intrinsics_.track_m == next.intrinsics_.track_m);
	const Eigen::Matrix3d R = delta_.R.toRotationMatrix();
	const Matrix6 A = transition(R, next.delta_.p, next.delta_.R.toRotationMatrix());
	Matrix6 G = Matrix6::Identity();
	G.block<3, 3>(kP, kP) = R;
	covariance_ = (A * covariance_ * A.transpose() + G * next.covariance_ * G.transpose()).eval();
	intrinsics_jacobian_ = (A * intrinsics_jacobian_ + G * next.intrinsics_jacobian_).eval();

	delta_ = delta_ * next.delta_;
	dt_s_ += next.dt_s_;
	distance_m_ += next.distance_m_;
	segments_.insert(segments_.end(), next.segments_.begin(), next.segments_.end());
}

void WheelPreintegration::scaleCovariance(double factor)
{
	for (WheelSegment& segment : segments_) segment.variance_scale *= factor;
	covariance_ *= factor;
}

bool WheelPreintegration::raiseVarianceScale(double least)
{
	bool raised = false;
	for (WheelSegment& segment : segments_)
	{
		if (segment.variance_scale >= least) continue;
		segment.variance_scale = least;
		raised = true;
	}
	if (raised) repropagate(intrinsics_);
	return raised;
}

void WheelPreintegration::setVarianceScales(const std::vector<double>& scales)
{
	assert(scales.size() == segments_.size());
	for (size_t i = 0; i < scales.size(); ++i) segments_[i].variance_scale = scales[i];
	repropagate(intrinsics_);
}

void WheelPreintegration::reset()
{
	dt_s_ = distance_m_ = 0;
	delta_ = {};
	covariance_.setZero();
	intrinsics_jacobian_.setZero();
}

void WheelPreintegration::repropagate(const WheelIntrinsics& at)
{
	intrinsics_ = at;
	reset();
	for (const WheelSegment& segment : segments_) integrateStep(segment);
}

Pose3 WheelPreintegration::corrected(const WheelIntrinsics& k) const
{
	const Eigen::Vector3d change(k.k_left - intrinsics_.k_left, k.k_right - intrinsics_.k_right, k.track_m - intrinsics_.track_m);
	const Eigen::Matrix<double, 6, 1> d = intrinsics_jacobian_ * change;
	return {(delta_.R * so3::expQuaternion(d.segment<3>(kPhi))).normalized(), delta_.p + d.segment<3>(kP)};
}
}  // namespace viwo
