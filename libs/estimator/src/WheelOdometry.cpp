#include "WheelOdometry.h"

#include "SampleBuffer.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
// What a robot that stands may have begun to do while nobody looked.
constexpr double kUnknownSpeed_m_s = 0.1;
constexpr double kUnknownTurn_rad_s = 0.2;
}  // namespace

WheelOdometry::WheelOdometry(const EstimatorOptions& options, const WheelIntrinsics& nominal)
    : noise_(options.noise.wheels), max_gap_s_(options.window.max_wheel_gap_s), wheels_(nominal)
{
	const PriorOptions& p = options.priors;
	const Eigen::Vector3d sigma(p.wheel_scale, p.wheel_scale, p.track_relative * nominal.track_m);
	wheels_covariance_ = sigma.cwiseAbs2().asDiagonal();
}

void WheelOdometry::reset(int64_t t_ns, const Pose3& T_WO, const Covariance& covariance, const WheelTwist& twist)
{
	t_ns_ = t_ns;
	T_WO_ = T_WO;
	twist_ = twist;
	white_ = covariance;
	by_intrinsics_.setZero();
}

void WheelOdometry::setIntrinsics(const WheelIntrinsics& wheels, const Eigen::Matrix3d& covariance)
{
	white_ = this->covariance();
	by_intrinsics_.setZero();
	wheels_ = wheels;
	wheels_covariance_ = covariance;
}

void WheelOdometry::add(const WheelPreintegration& interval)
{
	// p <- p + R dp, R <- R dR: the same chain as within an interval (Niu et al. Eq. 7), from interval to interval.
	const Eigen::Matrix3d R_WO = T_WO_.R.toRotationMatrix();
	Covariance A = Covariance::Identity(), B = A;
	A.topRightCorner<3, 3>() = -R_WO * so3::skew(interval.dp());
	A.bottomRightCorner<3, 3>() = interval.dR().toRotationMatrix().transpose();
	B.topLeftCorner<3, 3>() = R_WO;
	white_ = A * white_ * A.transpose() + B * interval.covariance() * B.transpose();
	by_intrinsics_ = A * by_intrinsics_ + B * interval.intrinsicsJacobian();
	T_WO_ = T_WO_ * Pose3(interval.dR(), interval.dp());
}

bool WheelOdometry::advance(const WheelBuffer& wheels, int64_t t_ns)
{
	if (t_ns <= t_ns_) return true;
	const auto segments = wheels.segments(t_ns_, t_ns, max_gap_s_);
	if (!segments)
	{
		if (!in_gap_) ++gaps_;
		in_gap_ = true;
		if (wheels.covers(t_ns)) passUnknown(t_ns);
		return false;
	}
	WheelPreintegration interval(noise_, wheels_);
	for (const WheelSegment& s : *segments) interval.integrate(s);
	add(interval);
	twist_ = twistOf({0, segments->back().v_left_m_s, segments->back().v_right_m_s}, wheels_);
	t_ns_ = t_ns;
	in_gap_ = false;
	return true;
}

void WheelOdometry::passUnknown(int64_t t_ns)
{
	const double gap_s = std::max(0.0, secondsBetween(t_ns_, t_ns));
	const double moved_m = std::max(kUnknownSpeed_m_s, std::abs(twist_.v_m_s)) * gap_s;
	const double turned_rad = std::min(M_PI, std::max(kUnknownTurn_rad_s, std::abs(twist_.w_rad_s)) * gap_s);
	white_.diagonal().head<3>().array() += square(moved_m);
	white_(5, 5) += square(turned_rad);
	t_ns_ = std::max(t_ns_, t_ns);
}

WheelOdometry::Covariance WheelOdometry::covariance() const
{
	return white_ + by_intrinsics_ * wheels_covariance_ * by_intrinsics_.transpose();
}

NavState WheelOdometry::bodyState(const Pose3& T_OB) const
{
	NavState s = bodyStateAt(T_WO_, T_OB, twist_);
	s.t_ns = t_ns_;
	return s;
}

NavState bodyStateAt(const Pose3& T_WO, const Pose3& T_OB, const WheelTwist& twist)
{
	NavState s;
	s.T_WB = T_WO * T_OB;
	const Eigen::Vector3d v_O = Eigen::Vector3d(twist.v_m_s, 0, 0) + Eigen::Vector3d(0, 0, twist.w_rad_s).cross(T_OB.p);
	s.v_WB = T_WO.R * v_O;
	return s;
}
}  // namespace viwo
