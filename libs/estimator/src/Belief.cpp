#include "Belief.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>

namespace viwo
{
namespace
{
/** A state that is not to be estimated: small against anything that matters, large enough for the arithmetic. */
constexpr double kFixed = 1e-6;
}  // namespace

Belief::Matrix6 Belief::biasCovarianceAt(int64_t t_ns, const ImuNoise& noise) const
{
	Matrix6 walked = bias_covariance;
	if (!found_ns) return walked;
	const double dt_s = std::max(0.0, secondsBetween(*found_ns, t_ns));
	walked.diagonal().head<3>().array() += square(noise.acc_walk_m_s3_sqrtHz) * dt_s;
	walked.diagonal().tail<3>().array() += square(noise.gyro_walk_rad_s2_sqrtHz) * dt_s;
	return walked;
}

Belief nominalBelief(const EstimatorOptions& options, const Calibration& calibration)
{
	const PriorOptions& p = options.priors;
	Belief b;
	b.bias_covariance.diagonal().head<3>().setConstant(square(p.acc_bias_m_s2));
	b.bias_covariance.diagonal().tail<3>().setConstant(square(p.gyro_bias_rad_s));
	b.T_BC = calibration.T_BC();
	const bool free_T_BC = options.factors.estimate_T_BC, free_wheels = options.factors.estimate_wheel_intrinsics;
	b.T_BC_covariance.diagonal().head<3>().setConstant(square(free_T_BC ? p.T_BC_translation_m : kFixed));
	b.T_BC_covariance.diagonal().tail<3>().setConstant(square(free_T_BC ? p.T_BC_rotation_deg * kDegree : kFixed));
	b.wheels = calibration.wheels;
	const Eigen::Vector3d wheels_sigma(p.wheel_scale, p.wheel_scale, p.track_relative * b.wheels.track_m);
	b.wheels_covariance.diagonal() = free_wheels ? Eigen::Vector3d(wheels_sigma.cwiseAbs2()) : Eigen::Vector3d::Constant(square(kFixed));
	return b;
}
}  // namespace viwo
