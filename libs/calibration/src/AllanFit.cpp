#include "NonNegativeFit.h"

#include <viwo/calibration/AllanFit.h>
#include <viwo/core/Error.h>
#include <viwo/core/Scalars.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace viwo
{
namespace
{
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector4d;
using Eigen::VectorXd;

constexpr double kFlatPart = 0.664;   // sqrt(2 ln 2 / pi)
constexpr double kModelError = 0.01;  // of a variance: no sensor follows the model better
constexpr double kHuber = 3;          // points that are farther off, in deviations, count less
constexpr double kPrice = 4;          // of a further coefficient, in chi^2
constexpr double kObserved = 2;       // coefficients, in deviations
constexpr double kMisfit = 3;         // of the short end, in deviations
constexpr double kLongestFilter_s = 0.3;
constexpr double kLeastFreedom = 5;  // of points at which the bias instability is read
constexpr double kFlat = 0.7;        // part of the flat term in the least variance, where the curve does not rise again
// Estimates an octave apart come from the same samples and err together; found by the spread of the results over many series.
constexpr double kShared = 2;
constexpr size_t kLeastPoints = 6;

/** The model's four terms at a cluster time, for the squares of Q, N, B, K. */
Vector4d termsAt(double tau_s)
{
	return {3 / square(tau_s), 1 / tau_s, square(kFlatPart), tau_s / 3};
}

/** What each kind of noise contributes. */
Vector4d partsAt(double tau_s, const Vector4d& coefficients)
{
	return coefficients.cwiseProduct(termsAt(tau_s)).cwiseAbs();
}

struct Octave
{
	const AllanPoint* point;
	Vector4d terms;
	double variance;
};

/** Every octave of the curve. */
std::vector<Octave> octavesOf(const AllanCurve& curve)
{
	std::vector<Octave> octaves;
	for (const AllanPoint& p : curve.points)
		if ((p.cluster & (p.cluster - 1)) == 0) octaves.push_back({&p, termsAt(p.tau_s), square(p.deviation)});
	return octaves;
}

/** Variance, relative to the square of the expected value, of an estimated Allan variance: each kind of noise has its own degrees of
 * freedom.
 */
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

struct Fit
{
	NonNegativeSolution solution;
	VectorXd pulls;  //!< residuals in deviations
	double misfit = 0;
};

/** Scoring for estimates that are spread like chi^2: weights come from the fitted curve, not from the scattered points, which would pull it
 * down. */
Fit fitOctaves(const AllanCurve& curve, const std::vector<Octave>& octaves)
{
	const auto n = static_cast<Index>(octaves.size());
	MatrixXd rows(n, 4);
	VectorXd values(n), model(n);
	for (Index i = 0; i < n; ++i)
	{
		rows.row(i) = octaves[static_cast<size_t>(i)].terms;
		values[i] = model[i] = octaves[static_cast<size_t>(i)].variance;
	}
	Fit fit;
	fit.pulls = VectorXd::Zero(n);
	Vector4d coefficients(0, 1, 0, 0);
	for (int iteration = 0; iteration < 30; ++iteration)
	{
		VectorXd deviation(n), root_weight(n);
		for (Index i = 0; i < n; ++i)
		{
			const Vector4d parts = partsAt(octaves[static_cast<size_t>(i)].point->tau_s, coefficients);
			deviation[i] =
			    model[i] * std::sqrt(relativeVariance(curve, octaves[static_cast<size_t>(i)].point->cluster, parts) + square(kModelError));
			root_weight[i] = std::sqrt(std::min(1.0, kHuber / std::max(1e-9, std::abs(fit.pulls[i])))) / deviation[i];
		}
		fit.solution = solveNonNegative(root_weight.asDiagonal() * rows, root_weight.cwiseProduct(values), kPrice);
		coefficients = fit.solution.x;
		model = (rows * coefficients).cwiseMax(1e-6 * values);
		fit.pulls = (values - rows * coefficients).cwiseQuotient(deviation);
	}
	const double free = std::max(1.0, static_cast<double>(n - fit.solution.free));
	fit.misfit = fit.pulls.squaredNorm() / free;
	fit.solution.covariance *= kShared * std::max(1.0, fit.misfit);
	fit.solution.loose_variance *= kShared * std::max(1.0, fit.misfit);
	return fit;
}

/** A sensor's low-pass filter makes neighbouring samples alike. Beyond its own time this takes from the variance a term of 1/tau^2, a
 * negative Q^2; the short end before that is left out, as long as it fits badly. */
Fit fitBeyondFilter(const AllanCurve& curve, std::vector<Octave>& octaves)
{
	const auto dropFirst = [&]
	{
		octaves.erase(octaves.begin());
		return fitOctaves(curve, octaves);
	};
	Fit fit = fitOctaves(curve, octaves);
	const size_t all = octaves.size();
	while (octaves.size() > kLeastPoints && octaves.front().point->tau_s < kLongestFilter_s &&
	       fit.pulls.head(3).cwiseAbs().maxCoeff() > kMisfit)
		fit = dropFirst();
	// What just passes still disturbs.
	if (octaves.size() < all && octaves.size() > kLeastPoints) fit = dropFirst();
	return fit;
}

/** @param square_value of the coefficient, with its deviation; @param loose_deviation: were all four free. */
NoiseReading readingOf(double square_value, double deviation, double loose_deviation)
{
	NoiseReading r;
	r.observed = square_value > kObserved * deviation;
	r.limit = std::sqrt(std::max(0.0, square_value) + 2 * std::max(deviation, loose_deviation));
	if (!r.observed) return r;
	r.value = std::sqrt(square_value);
	r.deviation = deviation / (2 * r.value);
	r.limit = r.value + 2 * r.deviation;
	return r;
}

/** Of the fitted curve: the lowest of scattered points would be too low. */
BiasInstability instabilityOf(const AllanCurve& curve, const Fit& fit, double shortest_s)
{
	const Vector4d& c = fit.solution.x;
	double least = std::numeric_limits<double>::infinity(), last_s = 0;
	BiasInstability b;
	for (const AllanPoint& p : curve.points)
	{
		if (2 / relativeVariance(curve, p.cluster, partsAt(p.tau_s, c)) < kLeastFreedom) break;
		last_s = p.tau_s;
		const double variance = c.dot(termsAt(p.tau_s));
		if (p.tau_s < shortest_s || variance >= least) continue;
		least = variance;
		b.tau_s = p.tau_s;
	}
	const Vector4d terms = termsAt(b.tau_s);
	b.value = std::sqrt(least) / kFlatPart;
	b.deviation = std::sqrt(terms.dot(fit.solution.covariance * terms)) / (2 * std::sqrt(least)) / kFlatPart;
	b.reached = b.tau_s < last_s || partsAt(b.tau_s, c)[2] > kFlat * least;
	return b;
}

/** Quantile of chi^2 over its degrees of freedom (Wilson and Hilferty). @param z of the normal distribution. */
double chiSquareRatio(double freedom, double z)
{
	const double spread = 2 / (9 * freedom);
	return std::pow(std::max(1e-3, 1 - spread + z * std::sqrt(spread)), 3);
}

std::vector<FittedPoint> fittedPoints(const AllanCurve& curve, const Vector4d& coefficients, double shortest_s)
{
	std::vector<FittedPoint> points;
	for (const AllanPoint& p : curve.points)
	{
		FittedPoint f;
		f.point = p;
		const double freedom = 2 / relativeVariance(curve, p.cluster, partsAt(p.tau_s, coefficients));
		f.model = std::sqrt(std::max(0.0, coefficients.dot(termsAt(p.tau_s))));
		f.low = p.deviation / std::sqrt(chiSquareRatio(freedom, 1.96));
		f.high = p.deviation / std::sqrt(chiSquareRatio(freedom, -1.96));
		f.used = p.tau_s >= shortest_s && (p.cluster & (p.cluster - 1)) == 0;
		points.push_back(f);
	}
	return points;
}

/** A walk K and white noise N cross at tau = sqrt(3) N / K; a log ten times as long shows the rise after it. */
double lengthForWalk(double white, double walk, double length_s)
{
	return std::max(2 * length_s, 10 * std::sqrt(3.0) * white / walk);
}

/** Of the curve between its last point and the one two octaves before. */
double lastSlope(const AllanCurve& curve)
{
	if (curve.points.size() < 9) return 0;
	const AllanPoint &a = curve.points[curve.points.size() - 9], &b = curve.points.back();
	return std::log(b.deviation / a.deviation) / std::log(b.tau_s / a.tau_s);
}
}  // namespace

NoiseModel fitNoise(const AllanCurve& curve)
{
	std::vector<Octave> octaves = octavesOf(curve);
	if (octaves.size() < kLeastPoints) throw Error("too few samples for an Allan deviation; record some minutes at least");
	for (const AllanPoint& p : curve.points)
		if (!(p.deviation > 0)) throw Error("the samples never change: the resolution hides the noise, or the sensor stood still");
	const double first_s = octaves.front().point->tau_s;
	const Fit fit = fitBeyondFilter(curve, octaves);

	NoiseModel model;
	for (const size_t length : curve.lengths) model.length_s += static_cast<double>(length) * curve.interval_s;
	const auto reading = [&](Index k)
	{ return readingOf(fit.solution.x[k], std::sqrt(fit.solution.covariance(k, k)), std::sqrt(fit.solution.loose_variance[k])); };
	model.quantisation = reading(0);
	model.white = reading(1);
	model.flicker = reading(2);
	model.walk = reading(3);
	if (!model.walk.observed) model.walk_needs_s = lengthForWalk(model.white.value, model.walk.limit, model.length_s);
	model.shortest_s = octaves.front().point->tau_s > first_s ? octaves.front().point->tau_s : 0;
	model.smoothed = model.shortest_s > 0 || fit.solution.x[0] < 0;
	model.instability = instabilityOf(curve, fit, model.shortest_s);
	model.misfit = fit.misfit;
	model.trend_slope = lastSlope(curve);
	model.points = fittedPoints(curve, fit.solution.x, octaves.front().point->tau_s);
	return model;
}
}  // namespace viwo
