#include "NoiseSeries.h"

#include <gtest/gtest.h>
#include <viwo/calibration/AllanDeviation.h>

#include <iostream>
#include <limits>

namespace viwo::testing
{
namespace
{
/** The definition, written out: non-overlapping is every m-th of these. */
double directDeviation(const std::vector<double>& x, size_t m)
{
	double sum = 0;
	size_t terms = 0;
	for (size_t i = 0; i + 2 * m <= x.size(); ++i, ++terms)
	{
		double first = 0, second = 0;
		for (size_t k = 0; k < m; ++k) first += x[i + k], second += x[i + m + k];
		sum += std::pow((second - first) / static_cast<double>(m), 2);
	}
	return std::sqrt(0.5 * sum / static_cast<double>(terms));
}

TEST(AllanDeviation, IsItsDefinition)
{
	const std::vector<double> x = noiseSeries({0, 1, 0, 0.3}, 0.01, 120, 1);
	const AllanCurve curve = allanCurve({x}, 0.01);
	ASSERT_GE(curve.points.size(), 15u);
	for (const AllanPoint& p : curve.points)
	{
		ASSERT_LE(4 * p.cluster, x.size());
		EXPECT_NEAR(p.tau_s, 0.01 * static_cast<double>(p.cluster), 1e-12);
		EXPECT_NEAR(p.deviation, directDeviation(x, p.cluster), 1e-12) << p.cluster;
	}
}

TEST(AllanDeviation, IsThatOfTheDifferencesWhateverTheMean)
{
	std::vector<double> x = noiseSeries({0, 1, 0, 0}, 0.01, 5000, 2);
	const AllanCurve without = allanCurve({x}, 0.01);
	for (double& value : x) value += 9.81e3;
	const AllanCurve with = allanCurve({x}, 0.01);
	for (size_t i = 0; i < with.points.size(); ++i) EXPECT_NEAR(with.points[i].deviation / without.points[i].deviation, 1, 1e-6);
}

TEST(AllanDeviation, ARampRisesWithItsSlope)
{
	std::vector<double> x(4000);
	for (size_t i = 0; i < x.size(); ++i) x[i] = 0.002 * static_cast<double>(i);
	for (const AllanPoint& p : allanCurve({x}, 0.01).points) EXPECT_NEAR(p.deviation, 0.2 * p.tau_s / std::sqrt(2.0), 1e-9);
}

TEST(AllanDeviation, LostSamplesAndPiecesLeaveWhiteNoiseAsItIs)
{
	std::vector<double> x = noiseSeries({0, 1e-3, 0, 0}, 0.005, 200000, 3);
	const AllanCurve whole = allanCurve({x}, 0.005);
	for (size_t i = 50; i < x.size(); i += 60) x[i] = std::numeric_limits<double>::quiet_NaN();
	const std::vector<double> first(x.begin(), x.begin() + 90000), second(x.begin() + 90000, x.end());
	const AllanCurve broken = allanCurve({first, second}, 0.005);
	double worst = 0;
	for (size_t i = 0; i < broken.points.size() && broken.points[i].tau_s < 5; ++i)
		worst = std::max(worst, std::abs(broken.points[i].deviation / whole.points[i].deviation - 1));
	std::cout << "[measured] one sample in 60 lost: deviations up to 5 s differ by at most " << 100 * worst << " %\n";
	EXPECT_LT(worst, 0.03);
}

/** The spread of estimates over many series, by the kind of their noise. */
TEST(AllanDeviation, DegreesOfFreedomAreThoseOfTheSpread)
{
	constexpr size_t kLength = 512;
	constexpr int kSeries = 600;
	const std::vector<std::pair<NoiseKind, NoiseDensities>> kinds{{NoiseKind::quantisation, {1, 0, 0, 0}},
	                                                              {NoiseKind::white, {0, 1, 0, 0}},
	                                                              {NoiseKind::flicker, {0, 0, 1, 0}},
	                                                              {NoiseKind::walk, {0, 0, 0, 1}}};
	for (const auto& [kind, densities] : kinds)
	{
		AllanCurve curve;
		std::vector<double> sum, sum_of_squares;
		for (int s = 0; s < kSeries; ++s)
		{
			curve = allanCurve({noiseSeries(densities, 1, kLength, 100 + static_cast<unsigned>(s))}, 1);
			sum.resize(curve.points.size());
			sum_of_squares.resize(curve.points.size());
			for (size_t i = 0; i < curve.points.size(); ++i)
			{
				const double variance = std::pow(curve.points[i].deviation, 2);
				sum[i] += variance / kSeries;
				sum_of_squares[i] += variance * variance / kSeries;
			}
		}
		double worst = 1;
		for (size_t i = 0; i < curve.points.size(); ++i)
		{
			const double measured = 2 * sum[i] * sum[i] / (sum_of_squares[i] - sum[i] * sum[i]);
			const double ratio = measured / curve.degreesOfFreedom(curve.points[i].cluster, kind);
			if (std::abs(std::log(ratio)) > std::abs(std::log(worst))) worst = ratio;
		}
		std::cout << "[measured] kind " << static_cast<int>(kind) << ": degrees of freedom, measured over computed, at worst " << worst
		          << "\n";
		EXPECT_GT(worst, 0.6);
		EXPECT_LT(worst, 1.7);
	}
}
}  // namespace
}  // namespace viwo::testing
