#include "NonNegativeFit.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <limits>
#include <vector>

namespace viwo
{
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector4d;
using Eigen::VectorXd;

NonNegativeSolution solveNonNegative(const MatrixXd& A, const VectorXd& b, double price)
{
	const Vector4d scales = A.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
	const MatrixXd columns = A * scales.cwiseInverse().asDiagonal();
	NonNegativeSolution best;
	double best_cost = b.squaredNorm();
	for (unsigned set = 1; set < 16; ++set)
	{
		std::vector<Index> free;
		for (Index k = 0; k < 4; ++k)
			if (set >> k & 1u) free.push_back(k);
		const MatrixXd part = columns(Eigen::all, free);
		const Eigen::ColPivHouseholderQR<MatrixXd> qr(part);
		if (qr.rank() < part.cols()) continue;
		const VectorXd y = qr.solve(b);
		const MatrixXd covariance = (part.transpose() * part).inverse();
		if (set == 15)
			for (Index k = 0; k < 4; ++k) best.loose_variance[k] = covariance(k, k) / (scales[k] * scales[k]);
		const double cost = (b - part * y).squaredNorm() + price * static_cast<double>(free.size());
		const Index bound = free.front() == 0 ? 1 : 0;
		if ((y.size() > bound && y.tail(y.size() - bound).minCoeff() < 0) || cost >= best_cost) continue;
		best_cost = cost;
		best.x.setZero();
		best.covariance.setZero();
		best.free = static_cast<int>(free.size());
		for (size_t i = 0; i < free.size(); ++i)
		{
			best.x[free[i]] = y[static_cast<Index>(i)] / scales[free[i]];
			for (size_t j = 0; j < free.size(); ++j)
				best.covariance(free[i], free[j]) =
				    covariance(static_cast<Index>(i), static_cast<Index>(j)) / (scales[free[i]] * scales[free[j]]);
		}
	}
	return best;
}
}  // namespace viwo
