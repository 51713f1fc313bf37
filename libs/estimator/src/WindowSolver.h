#pragma once

#include "Window.h"

#include <Eigen/Core>

namespace viwo
{
struct SolveReport
{
	bool usable = false;
	int iterations = 0;
};

/** Minimises the sum of all factors (paper Eq. 15) over all states of the window. One thread, capped iterations: repeatable. */
SolveReport solveWindow(Window& window, int max_iterations);

/** Covariance (tangents) of some blocks of the window, in their order: inverse of the information matrix of all factors at the present
 * states.
 *  @return false when no factor speaks of one of them, or the matrix is not positive definite.
 */
bool marginalCovariance(Window& window, const std::vector<double*>& blocks, Eigen::MatrixXd& covariance);

/** Covariance (15x15, StateOrder) of the latest frame, in the window's gauge.
 *  @return false when the matrix is not positive definite.
 */
bool latestCovariance(Window& window, Eigen::Matrix<double, 15, 15>& covariance);
}  // namespace viwo
