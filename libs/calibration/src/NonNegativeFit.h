#pragma once

#include <Eigen/Core>

namespace viwo
{
struct NonNegativeSolution
{
	Eigen::Vector4d x = Eigen::Vector4d::Zero();
	Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();      //!< 0 for coefficients at their bound
	Eigen::Vector4d loose_variance = Eigen::Vector4d::Zero();  //!< of each coefficient, were none of them bound
	int free = 0;                                              //!< coefficients that are not 0
};

/** min |A x - b| with x >= 0, the first coefficient alone of any sign, exactly: the best of all sets of coefficients that may differ from
 * 0. One more of them must lower the cost by more than `price`: what noise explains as well stays 0, or the others would pay for it. @param
 * A four columns, of any scales; rows and b in units of their deviations. */
NonNegativeSolution solveNonNegative(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double price);
}  // namespace viwo
