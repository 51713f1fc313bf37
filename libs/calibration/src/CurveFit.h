#pragma once

#include <viwo/calibration/AllanDeviation.h>

#include <Eigen/Core>
#include <vector>

namespace viwo
{
constexpr double kFlatPart = 0.664;  //!< sqrt(2 ln 2 / pi): the flat part of an Allan deviation over its bias instability

/** The model's four terms at a cluster time, for the squares of Q, N, B, K. */
Eigen::Vector4d termsAt(double tau_s);

/** What each kind of noise contributes to the variance. */
Eigen::Vector4d partsAt(double tau_s, const Eigen::Vector4d& coefficients);

/** Variance of an estimated Allan variance, relative to the square of its expected value: each kind of noise has its own degrees of
 * freedom.
 */
double relativeVariance(const AllanCurve& curve, size_t cluster, const Eigen::Vector4d& parts);

struct CurveFit
{
	Eigen::Vector4d x = Eigen::Vector4d::Zero();               //!< Q^2, N^2, B^2, K^2
	Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();      //!< 0 for coefficients that are 0
	Eigen::Vector4d loose_variance = Eigen::Vector4d::Zero();  //!< of each coefficient, were all of them free
	Eigen::VectorXd pulls;                                     //!< residuals in deviations
	double misfit = 0;                                         //!< chi^2 over its degrees of freedom
};

/** Of all sets of coefficients that may differ from 0 the likeliest, where one more must be worth its price: what noise explains as well
 * stays 0, or the others would pay for it. None is negative, but the first: samples that a sensor smoothes lack variance at short times.
 * @param points of the curve, an octave apart. */
CurveFit fitCurve(const AllanCurve& curve, const std::vector<AllanPoint>& points);
}  // namespace viwo
