#include "ImuAxes.h"

#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace viwo
{
namespace
{
/** Averaged over this before they are compared: odometry of 10 Hz resolves no less, and vibration is shorter. */
constexpr double kBin_s = 0.5;
/** A weaker correlation does not decide between four headings. */
constexpr double kClearCorrelation = 0.15;
/** Odometry whose speed changes less than this (rms) says nothing of accelerations. */
constexpr double kMinAcceleration_m_s2 = 0.02;

struct Bin
{
	Eigen::Vector3d force_B = Eigen::Vector3d::Zero(), gyro_B = Eigen::Vector3d::Zero();
	double v_m_s = 0, w_rad_s = 0;
	size_t imu_samples = 0, odometry_samples = 0;
};

/** By number, from the first sample on; those without any sample are not there, so that a stamp far off takes no memory. */
using Bins = std::map<int64_t, Bin>;

Bins meansOverTime(const std::vector<ImuSample>& imu, const std::vector<StampedTwist>& odometry)
{
	Bins bins;
	const auto binOf = [&](int64_t t_ns) -> Bin&
	{ return bins[static_cast<int64_t>(std::floor(secondsBetween(imu.front().t_ns, t_ns) / kBin_s))]; };
	for (const ImuSample& sample : imu)
	{
		Bin& bin = binOf(sample.t_ns);
		bin.force_B += sample.acc_m_s2, bin.gyro_B += sample.gyro_rad_s, ++bin.imu_samples;
	}
	for (const StampedTwist& sample : odometry)
	{
		if (!std::isfinite(sample.twist.v_m_s) || !std::isfinite(sample.twist.w_rad_s)) continue;
		Bin& bin = binOf(sample.t_ns);
		bin.v_m_s += sample.twist.v_m_s, bin.w_rad_s += sample.twist.w_rad_s, ++bin.odometry_samples;
	}
	for (auto& [number, bin] : bins)
	{
		bin.force_B /= std::max<double>(1, static_cast<double>(bin.imu_samples));
		bin.gyro_B /= std::max<double>(1, static_cast<double>(bin.imu_samples));
		bin.v_m_s /= std::max<double>(1, static_cast<double>(bin.odometry_samples));
		bin.w_rad_s /= std::max<double>(1, static_cast<double>(bin.odometry_samples));
	}
	return bins;
}

class Correlation
{
   public:
	void add(double a, double b) { ++n_, sum_a_ += a, sum_b_ += b, aa_ += a * a, bb_ += b * b, ab_ += a * b; }
	double varianceOfB() const { return n_ > 1 ? bb_ / n_ - std::pow(sum_b_ / n_, 2) : 0; }
	double value() const
	{
		const double variances = (aa_ / n_ - std::pow(sum_a_ / n_, 2)) * varianceOfB();
		return n_ < 10 || variances <= 0 ? 0 : (ab_ / n_ - sum_a_ / n_ * sum_b_ / n_) / std::sqrt(variances);
	}

   private:
	double n_ = 0, sum_a_ = 0, sum_b_ = 0, aa_ = 0, bb_ = 0, ab_ = 0;
};

/** The axis of B (with its sign) that points nearest to a direction. */
Eigen::Vector3d nearestAxis(const Eigen::Vector3d& direction_B)
{
	Eigen::Index axis = 0;
	direction_B.cwiseAbs().maxCoeff(&axis);
	return std::copysign(1.0, direction_B[axis]) * Eigen::Vector3d::Unit(axis);
}

Eigen::Quaterniond fromAxes(const Eigen::Vector3d& forward_B, const Eigen::Vector3d& up_B)
{
	Eigen::Matrix3d R_OB;
	R_OB << forward_B.transpose(), up_B.cross(forward_B).transpose(), up_B.transpose();
	return Eigen::Quaterniond(R_OB);
}

/** Correlation of the odometry's acceleration with the specific force along an axis; nothing where it hardly accelerates. */
std::optional<double> forwardCorrelation(const Bins& bins, const Eigen::Vector3d& axis_B)
{
	Correlation correlation;
	for (const auto& [number, bin] : bins)
	{
		const auto before = bins.find(number - 1), after = bins.find(number + 1);
		if (bin.imu_samples == 0 || before == bins.end() || after == bins.end()) continue;
		if (before->second.odometry_samples > 0 && after->second.odometry_samples > 0)
			correlation.add(axis_B.dot(bin.force_B), (after->second.v_m_s - before->second.v_m_s) / (2 * kBin_s));
	}
	if (correlation.varianceOfB() < kMinAcceleration_m_s2 * kMinAcceleration_m_s2) return std::nullopt;
	return correlation.value();
}
}  // namespace

std::optional<ImuAxes> guessImuAxes(const std::vector<ImuSample>& samples, const std::vector<StampedTwist>& odometry)
{
	std::vector<ImuSample> imu;
	std::copy_if(samples.begin(), samples.end(), std::back_inserter(imu), isFinite);
	if (imu.size() < 10) return std::nullopt;
	ImuAxes axes;
	for (const ImuSample& sample : imu) axes.mean_force_B_m_s2 += sample.acc_m_s2 / static_cast<double>(imu.size());
	const Eigen::Vector3d up_B = nearestAxis(axes.mean_force_B_m_s2);
	axes.tilt_rad = std::acos(std::clamp(up_B.dot(axes.mean_force_B_m_s2.normalized()), -1.0, 1.0));

	const Bins bins = meansOverTime(imu, odometry);
	// Without a drive that tells: the smallest turn that brings the axis up. Its forward axis is an axis of B again, as up is.
	const Eigen::Quaterniond smallest = Eigen::Quaterniond::FromTwoVectors(up_B, Eigen::Vector3d::UnitZ());
	Eigen::Vector3d forward_B = nearestAxis(smallest.conjugate() * Eigen::Vector3d::UnitX());
	Eigen::Vector3d candidate_B = forward_B;
	for (int quarter = 0; quarter < 4; ++quarter, candidate_B = up_B.cross(candidate_B).eval())
	{
		const auto correlation = forwardCorrelation(bins, candidate_B);
		if (!correlation || *correlation < std::max(kClearCorrelation, axes.forward_correlation.value_or(0))) continue;
		axes.forward_correlation = correlation;
		forward_B = candidate_B;
	}
	axes.R_OB = fromAxes(forward_B, up_B);

	Correlation yaw_rate;
	for (const auto& [number, bin] : bins)
		if (bin.imu_samples > 0 && bin.odometry_samples > 0) yaw_rate.add(up_B.dot(bin.gyro_B), bin.w_rad_s);
	if (yaw_rate.varianceOfB() > 1e-4) axes.yaw_rate_correlation = yaw_rate.value();
	return axes;
}
}  // namespace viwo
