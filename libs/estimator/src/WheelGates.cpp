#include "WheelGates.h"

#include "ImuPreintegration.h"
#include "WheelPreintegration.h"
#include "Window.h"

#include <viwo/core/Ranking.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace viwo
{
namespace
{
/** What the window does not know better at any time: bias of the gyro, velocity, and acceleration (bias and tilt). */
constexpr double kGyroBiasSigma_rad_s = 3e-3;
constexpr double kVelocitySigma_m_s = 0.01;
constexpr double kAccelerationSigma_m_s2 = 0.03;
/** Of the covariance of an interval that slips. */
constexpr double kSlipInflation = 1e4;
constexpr double kSameEvent_s = 1.0;

constexpr double kQuietGyro_rad_s = 0.012;
constexpr double kQuietGyroPeak_rad_s = 0.06;
constexpr size_t kEnoughTracks = 8;
constexpr double kQuietTrackSigmas = 1.5;
/** A robot that is pushed slowly moves its tracks by no more than their noise from frame to frame: only after this time it is said to
 * stand, */
constexpr double kSettling_s = 0.5;
/** and after this time its standing is looked at afresh, as tracks drift by themselves. */
constexpr double kStandstillMemory_s = 3;
constexpr double kCreepingTrackSigmas = 1;

/** Median movement of the tracks that both frames have, rad; nothing where they are few. */
std::optional<double> medianMovement(const FeatureFrame& before, const FeatureFrame& after)
{
	std::vector<double> moved;
	auto p = before.features.begin();
	for (const FeatureObservation& f : after.features)
	{
		while (p != before.features.end() && p->id < f.id) ++p;
		if (p == before.features.end()) break;
		if (p->id == f.id) moved.push_back((f.bearing_C - p->bearing_C).norm());
	}
	if (moved.size() < kEnoughTracks) return std::nullopt;
	return upperMedian(moved);
}
}  // namespace

SlipGate::SlipGate(const EstimatorOptions& options, const Calibration& calibration) : options_(options), calibration_(calibration) {}

double SlipGate::duration_s(size_t first) const
{
	double sum_s = 0;
	for (size_t i = first; i < steps_.size(); ++i) sum_s += steps_[i].imu->dt_s();
	return sum_s;
}

bool SlipGate::contradict(size_t first) const
{
	const Pose3& T_OB = calibration_.T_OB;
	const Eigen::Vector3d g_up(0, 0, options_.noise.gravity_m_s2);
	NavState s = steps_[first].before;
	double yaw_rad = 0, yaw_variance = 0, travel_m = 0, travel_variance = 0;  // wheels less IMU
	double duration_s = 0, distance_m = 0, turned_rad = 0;
	for (size_t i = first; i < steps_.size(); ++i)
	{
		const Step& step = steps_[i];
		const ImuDelta imu = step.imu->corrected(s.b_a, s.b_g);
		const double dt_s = step.imu->dt_s();
		const Eigen::Quaterniond R_OiOj_imu = T_OB.R * imu.gamma * T_OB.R.conjugate();
		const Eigen::Vector3d dp_B = s.T_WB.R.conjugate() * (s.v_WB * dt_s - 0.5 * g_up * dt_s * dt_s) + imu.alpha;
		const Eigen::Vector3d dp_O = T_OB.R * dp_B + T_OB.p - R_OiOj_imu * T_OB.p;
		const double yaw_imu_rad = so3::log(R_OiOj_imu).z();
		yaw_rad += so3::log(step.T_OiOj.R).z() - yaw_imu_rad;
		travel_m += step.T_OiOj.p.x() - dp_O.x();
		yaw_variance += step.yaw_variance + square(options_.noise.imu.gyro_noise_rad_s_sqrtHz) * dt_s;
		travel_variance += step.travel_variance;
		duration_s += dt_s;
		distance_m += step.distance_m;
		turned_rad += std::abs(yaw_imu_rad);
		s.v_WB += s.T_WB.R * imu.beta - g_up * dt_s;
		s.T_WB.R = (s.T_WB.R * imu.gamma).normalized();
	}
	// Errors of bias, velocity, scale and track are systematic: they add up over the time of the gate, unlike white noise.
	const PriorOptions& p = options_.priors;
	const double velocity_sigma_m_s = std::max(kVelocitySigma_m_s, steps_[first].velocity_sigma_m_s);
	yaw_variance += square(kGyroBiasSigma_rad_s * duration_s) + 2 * square(p.wheel_scale * distance_m / calibration_.wheels.track_m) +
	                square(p.track_relative * turned_rad);
	travel_variance += square(velocity_sigma_m_s * duration_s) + square(0.5 * kAccelerationSigma_m_s2 * duration_s * duration_s) +
	                   square(p.wheel_scale * distance_m);
	const double gate = square(options_.window.slip_gate_sigma);
	return square(yaw_rad) > gate * yaw_variance || square(travel_m) > gate * travel_variance;
}

std::optional<double> SlipGate::judge(const NavState& before, double velocity_sigma_m_s, const Interval& interval,
                                      const WheelIntrinsics& intrinsics)
{
	if (!options_.factors.slip_gate || !interval.wheels || !interval.imu)
	{
		steps_.clear();
		return std::nullopt;
	}
	const WheelPreintegration& wheels = *interval.wheels;
	steps_.push_back({before, velocity_sigma_m_s, std::make_shared<const ImuPreintegration>(*interval.imu), wheels.corrected(intrinsics),
	                  wheels.covariance()(5, 5), wheels.covariance()(0, 0), wheels.distance_m()});
	// Half an interval of grace: a sum of frame times is not to the nanosecond what was asked for.
	while (steps_.size() > 1 && duration_s(0) - 0.5 * steps_.front().imu->dt_s() > options_.window.slip_gate_window_s) steps_.pop_front();
	since_slip_s_ += interval.imu->dt_s();
	size_t first = steps_.size();
	while (first > 0 && !contradict(first - 1)) --first;
	if (first == 0) return std::nullopt;
	if (since_slip_s_ > kSameEvent_s) ++events_;
	since_slip_s_ = 0;
	return duration_s(first - 1);
}

void distrustWheels(Window& window, double duration_s)
{
	const int64_t since_ns = window.latest().t_ns - nanoseconds(duration_s);
	for (auto& frame : window.frames)
	{
		if (frame->t_ns <= since_ns || !frame->interval.wheels) continue;
		if (frame->interval.wheels->raiseVarianceScale(kSlipInflation)) frame->wheel_factor.reset();
	}
}

bool standsStill(const Interval& interval, const Eigen::Vector3d& b_g, const FeatureFrame& before, const FeatureFrame& after,
                 double sigma_rad)
{
	if (!interval.wheels || !interval.imu) return false;
	for (const WheelSegment& s : interval.wheels->segments())
		if (s.v_left_m_s != 0 || s.v_right_m_s != 0) return false;
	for (const ImuSample& s : interval.imu->samples())
		if ((s.gyro_rad_s - b_g).norm() > kQuietGyroPeak_rad_s) return false;
	const Eigen::Vector3d turned = so3::log(interval.imu->corrected(interval.imu->b_a(), b_g).gamma);
	if (turned.norm() > kQuietGyro_rad_s * interval.imu->dt_s()) return false;
	const std::optional<double> moved_rad = medianMovement(before, after);
	return !moved_rad || *moved_rad < kQuietTrackSigmas * sigma_rad;
}

bool StandstillGate::judge(const Interval& interval, const Eigen::Vector3d& b_g, const FeatureFrame& before, const FeatureFrame& after,
                           double sigma_rad)
{
	if (!standsStill(interval, b_g, before, after, sigma_rad))
	{
		reset();
		return false;
	}
	const int64_t begin_ns = interval.imu->t_begin_ns(), end_ns = interval.imu->t_end_ns();
	if (!quiet_since_ns_) quiet_since_ns_ = begin_ns;
	if (reference_.features.empty() || secondsBetween(reference_.t_ns, end_ns) > kStandstillMemory_s) reference_ = before;
	const std::optional<double> crept_rad = medianMovement(reference_, after);
	if (crept_rad && *crept_rad > kCreepingTrackSigmas * sigma_rad)
	{
		reset();
		return false;
	}
	return secondsBetween(*quiet_since_ns_, end_ns) >= kSettling_s;
}
}  // namespace viwo
