#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace viwo
{
/** L^-1 with covariance = L L^T: L^-1 r has unit covariance. Of a scaled copy with unit diagonal, which is padded until it is positive
 *  definite: an interval of hardly any noise weighs much, but stays finite. */
template <int N>
Eigen::Matrix<double, N, N> whitening(const Eigen::Matrix<double, N, N>& covariance)
{
	using Matrix = Eigen::Matrix<double, N, N>;
	using Vector = Eigen::Matrix<double, N, 1>;
	const Vector inverse_sigma = covariance.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
	const Matrix correlation = inverse_sigma.asDiagonal() * covariance * inverse_sigma.asDiagonal();
	Eigen::LLT<Matrix> llt(correlation);
	for (double pad = 1e-12; llt.info() != Eigen::Success && pad < 10; pad *= 10) llt.compute(correlation + pad * Matrix::Identity());
	Matrix whiten = Matrix::Identity();
	llt.matrixL().solveInPlace(whiten);
	return whiten * inverse_sigma.asDiagonal();
}
}  // namespace viwo
