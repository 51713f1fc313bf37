#include "CurveFit.h"

#include <viwo/core/Scalars.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace viwo
{
namespace
{
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector4d;
using Eigen::VectorXd;

constexpr double kModelError = 0.01;  // of a variance: no sensor follows the model better
constexpr double kHuber = 3;          // points that are farther off, in deviations, count less
constexpr double kPrice = 4;          // of a further coefficient, in twice the logarithm of the likelihood
constexpr int kIterations = 15;
// Estimates an octave apart come from the same samples and err together; found by the spread of the results over many series.
constexpr double kShared = 2;

/** One set of coefficients. */
class Candidate
{
   public:
	Candidate(const AllanCurve& curve, const std::vector<AllanPoint>& points, std::vector<Index> free)
	    : curve_(curve), points_(points), free_(std::move(free)), rows_(static_cast<Index>(points.size()), 4), values_(rows_.rows())
	{
		for (Index i = 0; i < rows_.rows(); ++i)
		{
			rows_.row(i) = termsAt(points_[static_cast<size_t>(i)].tau_s);
			values_[i] = square(points_[static_cast<size_t>(i)].deviation);
		}
		fit_.pulls = VectorXd::Zero(rows_.rows());
	}

	/** Scoring for estimates that are spread like chi^2: weights come from the fitted curve, not from the scattered points, which would
	 * pull it down. @return false where a coefficient wants to be negative. */
	bool solve()
	{
		VectorXd model = values_;
		for (const Index k : free_) fit_.x[k] = 1 / rows_.col(k).maxCoeff();
		for (int iteration = 0; iteration < kIterations; ++iteration)
		{
			setDeviations(model);
			if (!solveLinear()) return false;
			fit_.x.tail<3>() = fit_.x.tail<3>().cwiseMax(0.0);
			model = (rows_ * fit_.x).cwiseMax(1e-3 * values_);
			fit_.pulls = (values_ - rows_ * fit_.x).cwiseQuotient(deviation_);
		}
		if (unbound_.tail<3>().minCoeff() < 0) return false;
		finish(model);
		return true;
	}

	/** Minus twice the logarithm of the likelihood of the values, which are spread like chi^2. */
	double cost() const { return cost_; }
	const CurveFit& fit() const { return fit_; }

   private:
	void setDeviations(const VectorXd& model)
	{
		deviation_.resize(rows_.rows());
		for (Index i = 0; i < rows_.rows(); ++i)
		{
			const AllanPoint& p = points_[static_cast<size_t>(i)];
			deviation_[i] = model[i] * std::sqrt(relativeVariance(curve_, p.cluster, partsAt(p.tau_s, fit_.x)) + square(kModelError));
		}
	}

	MatrixXd weighedRows(const std::vector<Index>& columns) const { return rootWeights().asDiagonal() * rows_(Eigen::all, columns); }

	VectorXd rootWeights() const
	{
		const VectorXd huber = (kHuber / fit_.pulls.cwiseAbs().array().max(1e-9)).min(1.0).sqrt();
		return huber.cwiseQuotient(deviation_);
	}

	bool solveLinear()
	{
		MatrixXd A = weighedRows(free_);
		const VectorXd scales = A.colwise().norm();
		A *= scales.cwiseInverse().asDiagonal();
		const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
		if (qr.rank() < A.cols()) return false;
		const VectorXd y = qr.solve(rootWeights().cwiseProduct(values_)).cwiseQuotient(scales);
		unbound_.setZero();
		for (size_t i = 0; i < free_.size(); ++i) unbound_[free_[i]] = y[static_cast<Index>(i)];
		fit_.x = unbound_;
		return true;
	}

	MatrixXd covarianceOf(const std::vector<Index>& columns) const
	{
		MatrixXd A = weighedRows(columns);
		const VectorXd scales = A.colwise().norm();
		A *= scales.cwiseInverse().asDiagonal();
		const MatrixXd inverse = (A.transpose() * A).inverse();
		return kShared * std::max(1.0, fit_.misfit) * scales.cwiseInverse().asDiagonal() * inverse * scales.cwiseInverse().asDiagonal();
	}

	void finish(const VectorXd& model)
	{
		setDeviations(model);
		fit_.pulls = (values_ - rows_ * fit_.x).cwiseQuotient(deviation_);
		fit_.misfit = fit_.pulls.squaredNorm() / std::max(1.0, static_cast<double>(values_.size()) - static_cast<double>(free_.size()));
		const MatrixXd covariance = covarianceOf(free_);
		for (size_t i = 0; i < free_.size(); ++i)
			for (size_t j = 0; j < free_.size(); ++j)
				fit_.covariance(free_[i], free_[j]) = covariance(static_cast<Index>(i), static_cast<Index>(j));
		fit_.loose_variance = covarianceOf({0, 1, 2, 3}).diagonal();
		cost_ = 0;
		for (Index i = 0; i < values_.size(); ++i)
		{
			const double half = square(model[i] / deviation_[i]);  // half the degrees of freedom
			const double ratio = values_[i] / model[i];
			cost_ -= 2 * (half * std::log(half * ratio) - std::lgamma(half) - half * ratio);
		}
	}

	const AllanCurve& curve_;
	const std::vector<AllanPoint>& points_;
	std::vector<Index> free_;
	MatrixXd rows_;
	VectorXd values_, deviation_;
	Vector4d unbound_ = Vector4d::Zero();
	CurveFit fit_;
	double cost_ = 0;
};
}  // namespace

Vector4d termsAt(double tau_s)
{
	return {3 / square(tau_s), 1 / tau_s, square(kFlatPart), tau_s / 3};
}

Vector4d partsAt(double tau_s, const Vector4d& coefficients)
{
	return coefficients.cwiseProduct(termsAt(tau_s)).cwiseAbs();
}

double relativeVariance(const AllanCurve& curve, size_t cluster, const Vector4d& parts)
{
	double sum = 0;
	for (size_t kind = 0; kind < kNoiseKinds; ++kind)
	{
		const double freedom = std::max(1.0, curve.degreesOfFreedom(cluster, static_cast<NoiseKind>(kind)));
		sum += parts[static_cast<Index>(kind)] / parts.sum() * 2 / freedom;
	}
	return sum;
}

CurveFit fitCurve(const AllanCurve& curve, const std::vector<AllanPoint>& points)
{
	CurveFit best;
	double least = std::numeric_limits<double>::infinity();
	for (unsigned set = 1; set < 16; ++set)
	{
		std::vector<Index> free;
		for (Index k = 0; k < 4; ++k)
			if (set >> k & 1u) free.push_back(k);
		const double price = kPrice * static_cast<double>(free.size());
		Candidate candidate(curve, points, free);
		if (!candidate.solve() || candidate.cost() + price >= least) continue;
		least = candidate.cost() + price;
		best = candidate.fit();
	}
	return best;
}
}  // namespace viwo
