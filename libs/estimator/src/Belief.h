#pragma once

#include <viwo/core/Calibration.h>
#include <viwo/estimator/EstimatorOptions.h>

#include <Eigen/Core>
#include <optional>

#include "ClockOffsets.h"
#include "Excitation.h"

namespace viwo
{
/** What is held of biases and calibration before a window has measured anything: the configured priors, or what the window before it had
 * found. */
struct Belief
{
	using Matrix6 = Eigen::Matrix<double, 6, 6>;

	Eigen::Vector3d b_a = Eigen::Vector3d::Zero(), b_g = Eigen::Vector3d::Zero();
	Matrix6 bias_covariance = Matrix6::Zero();  //!< of [b_a, b_g], when they were found
	Pose3 T_BC;
	Matrix6 T_BC_covariance = Matrix6::Zero();  //!< tangent of a pose block
	WheelIntrinsics wheels;
	Eigen::Matrix3d wheels_covariance = Eigen::Matrix3d::Zero();  //!< of (k_left, k_right, track_m)
	Pose3 T_BO;
	Matrix6 T_BO_covariance = Matrix6::Zero();  //!< tangent of a pose block
	ClockOffsets offsets;
	double t_d_variance_s2 = 0, t_w_variance_s2 = 0;
	Excitation excitation;            //!< what the motion has shown so far
	std::optional<int64_t> found_ns;  //!< nothing: not found, but assumed

	/** Biases walk away from where they were found. */
	Matrix6 biasCovarianceAt(int64_t t_ns, const ImuNoise& noise) const;
};

/** The nominal calibration and no bias, with the configured deviations; what is not to be estimated is fixed. */
Belief nominalBelief(const EstimatorOptions& options, const Calibration& calibration);
}  // namespace viwo
