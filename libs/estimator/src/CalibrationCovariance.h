#pragma once

#include "Window.h"

#include <viwo/estimator/Estimator.h>

#include <Eigen/Core>
#include <optional>

namespace viwo
{
/** Covariances of what outlives a window, each for itself; those of states that the options leave out are missing. */
struct CalibrationCovariance
{
	Belief::Matrix6 biases = Belief::Matrix6::Zero();  //!< [b_a, b_g] of the latest frame
	std::optional<Belief::Matrix6> T_BC, T_BO;         //!< tangents of pose blocks
	std::optional<Eigen::Matrix3d> wheels;             //!< (k_left, k_right, track_m)
	std::optional<double> t_d_s2, t_w_s2;
};

/** @return nothing where the information matrix is not positive definite. */
std::optional<CalibrationCovariance> calibrationCovariance(Window& window);

/** What the window has found out about biases and calibration: what a window that follows it begins with. */
Belief learnedBelief(Window& window);

/** Deviations of what is estimated: of the window if it runs, else of its belief. */
CalibrationDeviations calibrationDeviations(Window& window, bool running);
}  // namespace viwo
