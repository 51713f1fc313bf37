#pragma once

#include <viwo/core/ImuSample.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "ImuPreintegration.h"
#include "SampleBuffer.h"

namespace viwo::test
{
/** A smooth motion as an ideal IMU feels it: specific force and angular rate in B as functions of time. */
struct ImuMotion
{
	double rate = 1;  //!< scales how lively it is
	Eigen::Vector3d acc(double t) const
	{
		return {rate * (0.8 * std::sin(3 * t) + 0.4), rate * 0.7 * std::cos(4 * t + 0.3), 9.81 + rate * 0.5 * std::sin(5 * t + 1)};
	}
	Eigen::Vector3d gyro(double t) const
	{
		return rate * Eigen::Vector3d(0.3 * std::sin(2 * t), 0.4 * std::cos(3 * t), 0.6 + 0.5 * std::sin(t));
	}
	ImuSample sample(int64_t t_ns) const { return {t_ns, acc(secondsBetween(0, t_ns)), gyro(secondsBetween(0, t_ns))}; }
};

/** Samples each period_ns from -period_ns to past t_end_ns. */
inline ImuBuffer sampled(const ImuMotion& motion, int64_t period_ns, int64_t t_end_ns)
{
	ImuBuffer buffer;
	for (int64_t t_ns = -period_ns; t_ns < t_end_ns + 2 * period_ns; t_ns += period_ns) buffer.add(motion.sample(t_ns));
	return buffer;
}

inline ImuPreintegration preintegrated(const ImuBuffer& buffer, int64_t t_begin_ns, int64_t t_end_ns, const ImuNoise& noise = {},
                                       const Eigen::Vector3d& b_a = Eigen::Vector3d::Zero(),
                                       const Eigen::Vector3d& b_g = Eigen::Vector3d::Zero())
{
	ImuPreintegration result(noise, b_a, b_g);
	result.integrate(buffer.span(t_begin_ns, t_end_ns, 1).value());
	return result;
}

/** [alpha, phi, beta] of `to` against `from`, the rotation on the right. */
inline Eigen::Matrix<double, 9, 1> difference(const ImuDelta& to, const ImuDelta& from)
{
	Eigen::Matrix<double, 9, 1> d;
	d << to.alpha - from.alpha, so3::log(Eigen::Quaterniond(from.gamma.conjugate() * to.gamma)), to.beta - from.beta;
	return d;
}
}  // namespace viwo::test
