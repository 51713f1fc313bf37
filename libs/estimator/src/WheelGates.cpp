#include "WheelGates.h"

#include "ImuPreintegration.h"
#include "StateOrder.h"
#include "WheelPreintegration.h"

#include <viwo/core/So3.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace viwo
{
namespace
{
/** What the window does not know better at any time: bias of the gyro, velocity of the prediction. */
constexpr double kGyroBiasSigma_rad_s = 3e-3;
constexpr double kVelocitySigma_m_s = 0.03;
/** Of the covariance of an interval that slips. */
constexpr double kSlipInflation = 1e4;
constexpr double kSameEvent_s = 1.0;

constexpr double kQuietGyro_rad_s = 0.012;
constexpr double kQuietGyroPeak_rad_s = 0.06;
constexpr size_t kEnoughTracks = 8;
constexpr double kQuietTrackSigmas = 1.5;

double square(double x) { return x * x; }
}  // namespace

SlipGate::SlipGate(const EstimatorOptions& options, const Calibration& calibration) : options_(options), calibration_(calibration) {}

SlipGate::Comparison SlipGate::compare(const NavState& before, const Interval& interval, const WheelIntrinsics& intrinsics) const
{
	const Pose3 T_OiOj = interval.wheels->corrected(intrinsics);
	const ImuDelta imu = interval.imu->corrected(before.b_a, before.b_g);
	const double dt_s = interval.imu->dt_s();
	const Pose3& T_OB = calibration_.T_OB;
	const Eigen::Quaterniond R_OiOj_imu = T_OB.R * imu.gamma * T_OB.R.conjugate();

	const Eigen::Vector3d g_up(0, 0, options_.noise.gravity_m_s2);
	const Eigen::Vector3d dp_B = before.T_WB.R.conjugate() * (before.v_WB * dt_s - 0.5 * g_up * dt_s * dt_s) + imu.alpha;
	const Eigen::Vector3d dp_O = T_OB.R * dp_B + T_OB.p - R_OiOj_imu * T_OB.p;

	Comparison c;
	c.dt_s = dt_s;
	c.yaw_rad = so3::log(T_OiOj.R).z() - so3::log(R_OiOj_imu).z();
	c.yaw_variance = interval.wheels->covariance()(5, 5) + square(options_.noise.imu.gyro_noise_rad_s_sqrtHz) * dt_s;
	c.travel_m = T_OiOj.p.x() - dp_O.x();
	c.travel_variance = interval.wheels->covariance()(0, 0);
	c.speed_m_s = interval.wheels->distance_m() / dt_s;
	c.yaw_rate_rad_s = so3::log(R_OiOj_imu).z() / dt_s;
	return c;
}

bool SlipGate::contradicts(const std::deque<Comparison>& comparisons) const
{
	Comparison sum;
	for (const Comparison& c : comparisons)
	{
		sum.dt_s += c.dt_s;
		sum.yaw_rad += c.yaw_rad;
		sum.yaw_variance += c.yaw_variance;
		sum.travel_m += c.travel_m;
		sum.travel_variance += c.travel_variance;
		sum.speed_m_s += c.speed_m_s * c.dt_s;
		sum.yaw_rate_rad_s += std::abs(c.yaw_rate_rad_s) * c.dt_s;
	}
	// Scale and track errors are systematic: they add up over the time of the gate, unlike white noise.
	const PriorOptions& p = options_.priors;
	const double track_m = calibration_.wheels.track_m;
	const double yaw_systematic = square(kGyroBiasSigma_rad_s * sum.dt_s) + 2 * square(p.wheel_scale * 0.5 * sum.speed_m_s * 2 / track_m) +
								  square(p.track_relative * sum.yaw_rate_rad_s);
	const double travel_systematic = square(kVelocitySigma_m_s * sum.dt_s) + square(p.wheel_scale * sum.speed_m_s);
	const double gate = square(options_.window.slip_gate_sigma);
	return square(sum.yaw_rad) > gate * (sum.yaw_variance + yaw_systematic) || square(sum.travel_m) > gate * (sum.travel_variance + travel_systematic);
}

bool SlipGate::judge(const NavState& before, Interval& interval, const WheelIntrinsics& intrinsics)
{
	if (!options_.factors.slip_gate || !interval.wheels || !interval.imu)
	{
		history_.clear();
		return false;
	}
	history_.push_back(compare(before, interval, intrinsics));
	double total_s = 0;
	for (const Comparison& c : history_) total_s += c.dt_s;
	while (history_.size() > 1 && total_s > options_.window.slip_gate_window_s)
	{
		total_s -= history_.front().dt_s;
		history_.pop_front();
	}
	since_slip_s_ += interval.imu->dt_s();
	const bool alone = contradicts({history_.back()});
	const bool together = contradicts(history_);
	if (!alone && !together) return false;
	if (since_slip_s_ > kSameEvent_s) ++events_;
	since_slip_s_ = 0;
	interval.slip = true;
	interval.wheels->scaleCovariance(kSlipInflation);
	return true;
}

bool standsStill(const Interval& interval, const Eigen::Vector3d& b_g, const FeatureFrame& before, const FeatureFrame& after, double sigma_rad)
{
	if (!interval.wheels) return false;
	for (const WheelSegment& s : interval.wheels->segments())
		if (s.v_left_m_s != 0 || s.v_right_m_s != 0) return false;

	bool quiet_gyro = false;
	if (interval.imu)
	{
		double peak = 0;
		for (const ImuSample& s : interval.imu->samples()) peak = std::max(peak, (s.gyro_rad_s - b_g).norm());
		const Eigen::Vector3d mean = so3::log(interval.imu->corrected(interval.imu->b_a(), b_g).gamma) / interval.imu->dt_s();
		quiet_gyro = mean.norm() < kQuietGyro_rad_s && peak < kQuietGyroPeak_rad_s;
	}

	std::vector<double> moved;
	auto p = before.features.begin();
	for (const FeatureObservation& f : after.features)
	{
		while (p != before.features.end() && p->id < f.id) ++p;
		if (p == before.features.end()) break;
		if (p->id == f.id) moved.push_back((f.bearing_C - p->bearing_C).norm());
	}
	if (moved.size() < kEnoughTracks) return quiet_gyro;
	std::nth_element(moved.begin(), moved.begin() + static_cast<std::ptrdiff_t>(moved.size() / 2), moved.end());
	return moved[moved.size() / 2] < kQuietTrackSigmas * sigma_rad;
}
}  // namespace viwo
