#include "WheelStart.h"

#include "ImuPreintegration.h"
#include "IntervalFactory.h"
#include "WheelOdometry.h"
#include "WheelPreintegration.h"
#include "residuals/BlockAlgebra.h"
#include "residuals/GaugePrior.h"
#include "residuals/StatePrior.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>

#include <cmath>

namespace viwo
{
namespace
{
constexpr double kGaugePosition_m = 1e-4;
constexpr double kGaugeYaw_rad = 1e-5;
/** Of one reading: ticks, slip. */
constexpr double kWheelSpeedSigma_m_s = 5e-3;
/** How much the floor may tilt the robot back and forth within the start, rad. */
constexpr double kRocking_rad = 5e-3;

/** Means over the whole of the frames' intervals. */
struct Totals
{
	double dt_s = 0;
	Eigen::Vector3d gyro_B = Eigen::Vector3d::Zero();  //!< mean rate, rad/s
	Eigen::Vector3d acc_O =
	    Eigen::Vector3d::Zero();  //!< mean specific force less the acceleration that the wheels tell, m/s^2, in O's axes
	double yaw_rad = 0, distance_m = 0, wheel_yaw_variance = 0;
};

double speedAt(const WheelSegment& s, const WheelIntrinsics& k)
{
	return twistOf({0, s.v_left_m_s, s.v_right_m_s}, k).v_m_s;
}

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
		const ImuDelta imu = interval.imu->corrected(w.belief.b_a, interval.imu->b_g());
		velocity_change_O += w.calibration.T_OB.R * imu.beta - Eigen::Vector3d(0, interval.wheels->dp().x() * yaw_rad / dt_s, 0);
	}
	const double v_begin = speedAt(w.frames[1]->interval.wheels->segments().front(), k);
	const double v_end = speedAt(w.frames.back()->interval.wheels->segments().back(), k);
	velocity_change_O.x() -= v_end - v_begin;
	t.gyro_B /= t.dt_s;
	t.acc_O = velocity_change_O / t.dt_s;
	return t;
}

/** Rotation vector (in O, x and y) that tilts the floor's normal to the measured up, weighted with the floor being level. */
Eigen::Quaterniond tiltOf(const Totals& t, const EstimatorOptions& o, const Belief& belief)
{
	const Eigen::Quaterniond R_WO_acc = Eigen::Quaterniond::FromTwoVectors(t.acc_O, Eigen::Vector3d::UnitZ());
	const double sigma_acc = std::sqrt(belief.bias_covariance.diagonal().head<3>().maxCoeff()) / o.noise.gravity_m_s2;
	const double sigma_floor = o.priors.plane_tilt_deg * kDegree;
	const double weight = o.usePlaneFactor() ? square(sigma_floor) / (square(sigma_floor) + square(sigma_acc)) : 1;
	return so3::expQuaternion(weight * so3::log(R_WO_acc));
}

/** Per axis of O: what the gyro reads less what the wheels turn, weighted with what was held of it before. */
Eigen::Vector3d gyroBiasOf(const Window& w, const Totals& t)
{
	const EstimatorOptions& o = w.options;
	const double speed = t.distance_m / t.dt_s;
	const double scale_yaw = std::sqrt(2.0) * o.priors.wheel_scale * speed / w.wheels[2];
	const double track_yaw = o.priors.track_relative * std::abs(t.yaw_rad) / t.dt_s;
	const double white = square(o.noise.imu.gyro_noise_rad_s_sqrtHz) / t.dt_s;
	const double yaw_variance = square(scale_yaw) + square(track_yaw) + white + t.wheel_yaw_variance / square(t.dt_s);
	const double tilt_variance = (t.distance_m > 0 ? square(kRocking_rad / t.dt_s) : 0) + white;

	const Eigen::Vector3d measured_O = w.calibration.T_OB.R * (t.gyro_B - w.belief.b_g) - Eigen::Vector3d(0, 0, t.yaw_rad / t.dt_s);
	const double prior = w.belief.bias_covariance.diagonal().tail<3>().maxCoeff();
	const Eigen::Vector3d weight(prior / (prior + tilt_variance), prior / (prior + tilt_variance), prior / (prior + yaw_variance));
	return w.belief.b_g + w.calibration.T_OB.R.conjugate() * weight.cwiseProduct(measured_O);
}

/** Where wheel factors follow, they say what the wheels know. Without them this prior is all that carries the wheels' scale into the
 * window. */
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
	const Eigen::Vector3d b_g = gyroBiasOf(w, totals);
	intervals.relinearizeAt(w, w.belief.b_a, b_g);

	const WheelIntrinsics k = w.wheelIntrinsics();
	const double yaw_rad = yawOf(T_WO_latest.R);
	Pose3 T_WO(Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())) * tiltOf(totals, w.options, w.belief),
	           T_WO_latest.p);
	// The tilt turns the heading by second order only; taking it out keeps yaw exactly as asked.
	T_WO.R = Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad - yawOf(T_WO.R), Eigen::Vector3d::UnitZ())) * T_WO.R;
	for (size_t i = w.frames.size(); i-- > 0;)
	{
		const auto& wheels = w.frames[std::max<size_t>(i, 1)]->interval.wheels;
		const WheelSegment& s = i == 0 ? wheels->segments().front() : wheels->segments().back();
		NavState state = bodyStateAt(T_WO, w.calibration.T_OB, twistOf({0, s.v_left_m_s, s.v_right_m_s}, k));
		state.b_a = w.belief.b_a;
		state.b_g = b_g;
		state.t_ns = w.frames[i]->t_ns;
		w.frames[i]->setState(state);
		if (i > 0) T_WO = T_WO * wheels->corrected(k).inverse();
	}
	addStartPriors(w, w.latest(), velocitySigma_m_s(w));
	return true;
}

void addStartPriors(Window& w, Frame& gauge, double velocity_sigma_m_s)
{
	const EstimatorOptions& o = w.options;
	const Belief& belief = w.belief;
	const auto add = [&](const std::shared_ptr<LocalCost>& cost, double* block) { w.start_priors.push_back({cost, nullptr, {block}}); };
	gauge.keyframe = true;  // as long as it carries the gauge it must not be dropped
	const Pose3 T_WB = poseFromBlock(gauge.pose.data());
	add(std::make_shared<GaugePrior>(T_WB, w.calibration.T_BO().p, kGaugePosition_m, kGaugeYaw_rad), gauge.pose.data());

	// Centred on what was held before: what the start measured of the biases is in the factors, and is not counted twice.
	Frame& oldest = *w.frames.front();
	Eigen::Matrix<double, 9, 1> motion = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(oldest.motion.data());
	motion.tail<6>() << belief.b_a, belief.b_g;
	Eigen::Matrix<double, 9, 9> motion_covariance = square(velocity_sigma_m_s) * Eigen::Matrix<double, 9, 9>::Identity();
	motion_covariance.bottomRightCorner<6, 6>() = belief.biasCovarianceAt(oldest.t_ns, o.noise.imu);
	add(StatePrior::fromCovariance(BlockShape::euclidean(9), motion.data(), motion_covariance), oldest.motion.data());

	if (o.useCamera()) add(StatePrior::fromCovariance(BlockShape::pose(), w.T_BC.data(), belief.T_BC_covariance), w.T_BC.data());
	if (o.useWheelFactor())
		add(StatePrior::fromCovariance(BlockShape::euclidean(3), w.wheels.data(), belief.wheels_covariance), w.wheels.data());
	const auto addOffset = [&](double* offset_s, double variance_s2) {
		add(std::make_shared<StatePrior>(BlockShape::euclidean(1), offset_s, Eigen::VectorXd::Constant(1, std::sqrt(variance_s2))),
		    offset_s);
	};
	if (o.calibratesWheels() || o.freeCameraOffset()) addOffset(&w.t_d_s, belief.t_d_variance_s2);
	if (o.calibratesWheels())
	{
		addOffset(&w.t_w_s, belief.t_w_variance_s2);
		add(StatePrior::fromCovariance(BlockShape::pose(), w.T_BO.data(), belief.T_BO_covariance), w.T_BO.data());
	}

	if (!o.usePlaneFactor() || o.factors.plane_pairwise) return;
	const double tilt_sigma = o.priors.plane_tilt_deg * kDegree;
	w.plane()[2] = (T_WB * w.calibration.T_BO().p).z();
	const Eigen::Vector3d plane_sigma(tilt_sigma, tilt_sigma, o.priors.plane_factor_height_m);
	add(std::make_shared<StatePrior>(BlockShape::euclidean(3), w.plane().data(), plane_sigma), w.plane().data());
}
}  // namespace viwo
