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

/** Along O's axes the height of B over the floor is no more than assumed: planar motion does not show it. */
Belief::Matrix6 mountingCovariance(const EstimatorOptions& options, const Pose3& T_BO)
{
	const PriorOptions& p = options.priors;
	const bool is_free = options.freeMounting();
	const double sigma_m = is_free ? p.T_BO_translation_m : kFixed, sigma_rad = is_free ? p.T_BO_rotation_deg * kDegree : kFixed;
	const Eigen::Matrix3d R_BO = T_BO.R.toRotationMatrix();
	Belief::Matrix6 covariance = Belief::Matrix6::Zero();
	covariance.topLeftCorner<3, 3>() =
	    R_BO * Eigen::Vector3d(square(sigma_m), square(sigma_m), square(kFixed)).asDiagonal() * R_BO.transpose();
	covariance.diagonal().tail<3>().setConstant(square(sigma_rad));
	return covariance;
}
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
	b.T_BO = calibration.T_BO();
	b.T_BO_covariance = mountingCovariance(options, b.T_BO);
	b.t_d_variance_s2 = square(options.freeCameraOffset() ? p.camera_clock_s : kFixed);
	b.t_w_variance_s2 = square(options.freeWheelOffset() ? p.wheel_clock_s : kFixed);
	return b;
}
}  // namespace viwo
