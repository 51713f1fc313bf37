#include <viwo/calibration/AllanFit.h>
#include <viwo/core/Error.h>
#include <viwo/core/Scalars.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "CurveFit.h"

namespace viwo
{
namespace
{
using Eigen::Index;
using Eigen::Vector4d;

constexpr double kObserved = 1.5;  // coefficients, in deviations; the fit has asked more of them already
constexpr double kMisfit = 3;      // of the short end, in deviations
constexpr double kLongestFilter_s = 0.3;
constexpr double kLeastFreedom = 5;  // of points at which the bias instability is read
constexpr double kFlat = 0.7;        // part of the flat term in the least variance, where the curve does not rise again
constexpr size_t kLeastPoints = 6;

bool isOctave(const AllanPoint& p)
{
	return (p.cluster & (p.cluster - 1)) == 0;
}

/** A sensor's low-pass filter makes neighbouring samples alike. Beyond its own time this takes from the variance a term of 1/tau^2, a
 * negative Q^2; the short end before that is left out, as long as it fits badly. */
CurveFit fitBeyondFilter(const AllanCurve& curve, std::vector<AllanPoint>& octaves)
{
	const auto dropFirst = [&]
	{
		octaves.erase(octaves.begin());
		return fitCurve(curve, octaves);
	};
	CurveFit fit = fitCurve(curve, octaves);
	const size_t all = octaves.size();
	while (octaves.size() > kLeastPoints && octaves.front().tau_s < kLongestFilter_s && fit.pulls.head(3).cwiseAbs().maxCoeff() > kMisfit)
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
BiasInstability instabilityOf(const AllanCurve& curve, const CurveFit& fit, double shortest_s)
{
	const Vector4d& c = fit.x;
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
	b.deviation = std::sqrt(terms.dot(fit.covariance * terms)) / (2 * std::sqrt(least)) / kFlatPart;
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
		f.used = p.tau_s >= shortest_s && isOctave(p);
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
	std::vector<AllanPoint> octaves;
	std::copy_if(curve.points.begin(), curve.points.end(), std::back_inserter(octaves), isOctave);
	if (octaves.size() < kLeastPoints) throw Error("too few samples for an Allan deviation; record some minutes at least");
	for (const AllanPoint& p : curve.points)
		if (!(p.deviation > 0)) throw Error("the samples never change: the resolution hides the noise, or the sensor stood still");
	const double first_s = octaves.front().tau_s;
	const CurveFit fit = fitBeyondFilter(curve, octaves);

	NoiseModel model;
	for (const size_t length : curve.lengths) model.length_s += static_cast<double>(length) * curve.interval_s;
	const auto reading = [&](Index k) { return readingOf(fit.x[k], std::sqrt(fit.covariance(k, k)), std::sqrt(fit.loose_variance[k])); };
	model.quantisation = reading(0);
	model.white = reading(1);
	model.flicker = reading(2);
	model.walk = reading(3);
	if (!model.walk.observed) model.walk_needs_s = lengthForWalk(model.white.value, model.walk.limit, model.length_s);
	model.shortest_s = octaves.front().tau_s > first_s ? octaves.front().tau_s : 0;
	model.smoothed = model.shortest_s > 0 || fit.x[0] < 0;
	model.instability = instabilityOf(curve, fit, model.shortest_s);
	model.misfit = fit.misfit;
	model.trend_slope = lastSlope(curve);
	model.points = fittedPoints(curve, fit.x, octaves.front().tau_s);
	return model;
}
}  // namespace viwo
