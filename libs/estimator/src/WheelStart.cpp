#include "WheelStart.h"

#include "ImuPreintegration.h"
#include "IntervalFactory.h"
#include "WheelPreintegration.h"
#include "residuals/BlockAlgebra.h"
#include "residuals/GaugePrior.h"
#include "residuals/StatePrior.h"

#include <viwo/core/So3.h>

#include <cmath>

namespace viwo
{
namespace
{
constexpr double kDegree = M_PI / 180;
constexpr double kGaugePosition_m = 1e-4;
constexpr double kGaugeYaw_rad = 1e-5;
/** A state that is not to be estimated: small against anything that matters, large enough for the arithmetic. */
constexpr double kFixed = 1e-6;
/** How much the floor may tilt the robot back and forth within the start, rad. */
constexpr double kWheelSpeedSigma_m_s = 5e-3;	// of one reading: ticks, slip
constexpr double kRocking_rad = 5e-3;

double square(double x) { return x * x; }

/** Means over the whole of the frames' intervals. */
struct Totals
{
	double dt_s = 0;
	Eigen::Vector3d gyro_B = Eigen::Vector3d::Zero();  //!< mean rate, rad/s
	Eigen::Vector3d acc_O = Eigen::Vector3d::Zero();  //!< mean specific force less the acceleration that the wheels tell, m/s^2, in O's axes
	double yaw_rad = 0, distance_m = 0, wheel_yaw_variance = 0;
};

double speedAt(const WheelSegment& s, const WheelIntrinsics& k) { return twistOf({0, s.v_left_m_s, s.v_right_m_s}, k).v_m_s; }

Totals sumUp(const Window& w)
{
	Totals t;
	const WheelIntrinsics k = w.wheelIntrinsics();
	Eigen::Vector3d velocity_change_O = Eigen::Vector3d::Zero();  // integral of specific force
	for (size_t i = 1; i < w.frames.size(); ++i)
	{
		const Interval& interval = w.frames[i]->interval;
		const double dt_s = interval.imu->dt_s();
		const double yaw_rad = so3::log(interval.wheels->dR()).z();
		t.dt_s += dt_s;
		t.gyro_B += so3::log(interval.imu->delta().gamma) + interval.imu->b_g() * dt_s;
		t.yaw_rad += yaw_rad;
		t.distance_m += interval.wheels->distance_m();
		t.wheel_yaw_variance += interval.wheels->covariance()(5, 5);
		// Centripetal acceleration of O, to the left: v * w.
		velocity_change_O += w.calibration.T_OB.R * interval.imu->delta().beta - Eigen::Vector3d(0, interval.wheels->dp().x() * yaw_rad / dt_s, 0);
	}
	const double v_begin = speedAt(w.frames[1]->interval.wheels->segments().front(), k);
	const double v_end = speedAt(w.frames.back()->interval.wheels->segments().back(), k);
	velocity_change_O.x() -= v_end - v_begin;
	t.gyro_B /= t.dt_s;
	t.acc_O = velocity_change_O / t.dt_s;
	return t;
}

/** Rotation vector (in O, x and y) that tilts the floor's normal to the measured up, weighted with the floor being level. */
Eigen::Quaterniond tiltOf(const Totals& t, const EstimatorOptions& o)
{
	const Eigen::Quaterniond R_WO_acc = Eigen::Quaterniond::FromTwoVectors(t.acc_O, Eigen::Vector3d::UnitZ());
	const double sigma_acc = o.priors.acc_bias_m_s2 / o.noise.gravity_m_s2;
	const double sigma_floor = o.priors.plane_tilt_deg * kDegree;
	const double weight = o.usePlaneFactor() ? square(sigma_floor) / (square(sigma_floor) + square(sigma_acc)) : 1;
	return so3::expQuaternion(weight * so3::log(R_WO_acc));
}

struct GyroBias
{
	Eigen::Vector3d b_g = Eigen::Vector3d::Zero();
	double sigma_rad_s = 0;
};

/** Per axis of O: what the gyro reads less what the wheels turn, weighted with the prior around zero. */
GyroBias gyroBiasOf(const Window& w, const Totals& t)
{
	const EstimatorOptions& o = w.options;
	const double speed = t.distance_m / t.dt_s;
	const double scale_yaw = std::sqrt(2.0) * o.priors.wheel_scale * 0.5 * speed * 2 / w.wheels[2];
	const double track_yaw = o.priors.track_relative * std::abs(t.yaw_rad) / t.dt_s;
	const double white = square(o.noise.imu.gyro_noise_rad_s_sqrtHz) / t.dt_s;
	const double yaw_variance = square(scale_yaw) + square(track_yaw) + white + t.wheel_yaw_variance / square(t.dt_s);
	const double tilt_variance = (t.distance_m > 0 ? square(kRocking_rad / t.dt_s) : 0) + white;

	const Eigen::Vector3d measured_O = w.calibration.T_OB.R * t.gyro_B - Eigen::Vector3d(0, 0, t.yaw_rad / t.dt_s);
	const double prior = square(o.priors.gyro_bias_rad_s);
	const Eigen::Vector3d weight(prior / (prior + tilt_variance), prior / (prior + tilt_variance), prior / (prior + yaw_variance));
	return {w.calibration.T_OB.R.conjugate() * weight.cwiseProduct(measured_O), o.priors.gyro_bias_rad_s};
}

NavState stateAt(const Window& w, const Pose3& T_WO, const WheelTwist& twist, const Eigen::Vector3d& b_g)
{
	NavState s;
	s.T_WB = T_WO * w.calibration.T_OB;
	const Eigen::Vector3d v_O = Eigen::Vector3d(twist.v_m_s, 0, 0) + Eigen::Vector3d(0, 0, twist.w_rad_s).cross(w.calibration.T_OB.p);
	s.v_WB = T_WO.R * v_O;
	s.b_g = b_g;
	return s;
}
/** Where wheel factors follow, they say what the wheels know. Without them this prior is all that carries the wheels' scale into the window. */
double velocitySigma_m_s(const Window& w)
{
	if (w.options.useWheelFactor()) return w.options.priors.velocity_m_s;
	const double speed_m_s = w.frames.front()->state().v_WB.norm();
	return std::min(w.options.priors.velocity_m_s, kWheelSpeedSigma_m_s + w.options.priors.wheel_scale * speed_m_s);
}
}  // namespace

bool startFromWheels(Window& w, IntervalFactory& intervals, const Pose3& T_WO_latest)
{
	if (w.frames.size() < 2) return false;
	for (size_t i = 1; i < w.frames.size(); ++i)
		if (!w.frames[i]->interval.imu || !w.frames[i]->interval.wheels) return false;

	const Totals totals = sumUp(w);
	const GyroBias bias = gyroBiasOf(w, totals);
	intervals.relinearizeAt(w, Eigen::Vector3d::Zero(), bias.b_g);

	const WheelIntrinsics k = w.wheelIntrinsics();
	const double yaw_rad = yawOf(T_WO_latest.R);
	Pose3 T_WO(Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())) * tiltOf(totals, w.options), T_WO_latest.p);
	// The tilt turns the heading by second order only; taking it out keeps yaw exactly as asked.
	T_WO.R = Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad - yawOf(T_WO.R), Eigen::Vector3d::UnitZ())) * T_WO.R;
	for (size_t i = w.frames.size(); i-- > 0;)
	{
		const auto& wheels = w.frames[std::max<size_t>(i, 1)]->interval.wheels;
		const WheelSegment& s = i == 0 ? wheels->segments().front() : wheels->segments().back();
		NavState state = stateAt(w, T_WO, twistOf({0, s.v_left_m_s, s.v_right_m_s}, k), bias.b_g);
		state.t_ns = w.frames[i]->t_ns;
		w.frames[i]->setState(state);
		if (i > 0) T_WO = T_WO * wheels->corrected(k).inverse();
	}
	addStartPriors(w, w.latest(), velocitySigma_m_s(w), bias.sigma_rad_s);
	return true;
}

void addStartPriors(Window& w, Frame& gauge, double velocity_sigma_m_s, double gyro_bias_sigma_rad_s)
{
	const EstimatorOptions& o = w.options;
	gauge.keyframe = true;	// as long as it carries the gauge it must not be dropped
	w.start_priors.push_back({std::make_shared<GaugePrior>(poseFromBlock(gauge.pose.data()), w.calibration.T_BO().p, kGaugePosition_m, kGaugeYaw_rad), nullptr, {gauge.pose.data()}});

	// Centred on no bias: what the start measured of it is in the factors, and is not counted twice.
	Frame& oldest = *w.frames.front();
	Eigen::Matrix<double, 9, 1> motion = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(oldest.motion.data()), motion_sigma;
	motion.tail<6>().setZero();
	motion_sigma << Eigen::Vector3d::Constant(velocity_sigma_m_s), Eigen::Vector3d::Constant(o.priors.acc_bias_m_s2),
		Eigen::Vector3d::Constant(gyro_bias_sigma_rad_s);
	w.start_priors.push_back({std::make_shared<StatePrior>(BlockShape::euclidean(9), motion.data(), motion_sigma), nullptr, {oldest.motion.data()}});

	Eigen::Matrix<double, 6, 1> T_BC_sigma = Eigen::Matrix<double, 6, 1>::Constant(kFixed);
	if (o.factors.estimate_T_BC)
		T_BC_sigma << Eigen::Vector3d::Constant(o.priors.T_BC_translation_m), Eigen::Vector3d::Constant(o.priors.T_BC_rotation_deg * kDegree);
	if (o.useCamera()) w.start_priors.push_back({std::make_shared<StatePrior>(BlockShape::pose(), w.T_BC.data(), T_BC_sigma), nullptr, {w.T_BC.data()}});

	Eigen::Vector3d wheel_sigma = Eigen::Vector3d::Constant(kFixed);
	if (o.factors.estimate_wheel_intrinsics) wheel_sigma << o.priors.wheel_scale, o.priors.wheel_scale, o.priors.track_relative * w.wheels[2];
	if (o.useWheelFactor())
		w.start_priors.push_back({std::make_shared<StatePrior>(BlockShape::euclidean(3), w.wheels.data(), wheel_sigma), nullptr, {w.wheels.data()}});

	if (!o.usePlaneFactor() || o.factors.plane_pairwise) return;
	const double tilt_sigma = o.priors.plane_tilt_deg * kDegree;
	w.plane()[2] = poseFromBlock(gauge.pose.data()).p.z() + (poseFromBlock(gauge.pose.data()).R * w.calibration.T_BO().p).z();
	w.start_priors.push_back({std::make_shared<StatePrior>(BlockShape::euclidean(3), w.plane().data(), Eigen::Vector3d(tilt_sigma, tilt_sigma, o.priors.plane_factor_height_m)),
		nullptr, {w.plane().data()}});
}
}  // namespace viwo
