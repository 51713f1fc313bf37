#include "ExpectError.h"
#include "NoiseSeries.h"

#include <viwo/calibration/AllanFit.h>

#include <algorithm>
#include <iostream>

namespace viwo::testing
{
namespace
{
constexpr double kInterval_s = 0.02;

NoiseModel fitted(const NoiseDensities& densities, double length_s, unsigned seed)
{
	const auto count = static_cast<size_t>(length_s / kInterval_s);
	return fitNoise(allanCurve({noiseSeries(densities, kInterval_s, count, seed)}, kInterval_s));
}

/** Errors of a reading in its own deviations, over many series. */
struct Pulls
{
	int observed = 0, beyond_limit = 0;
	double sum = 0, sum_of_squares = 0, relative = 0;

	void add(const NoiseReading& reading, double truth)
	{
		beyond_limit += reading.limit < truth ? 1 : 0;
		if (!reading.observed) return;
		++observed;
		const double pull = (reading.value - truth) / reading.deviation;
		sum += pull;
		sum_of_squares += pull * pull;
		relative += reading.value / truth;
	}
	double mean() const { return sum / std::max(1, observed); }
	double rms() const { return std::sqrt(sum_of_squares / std::max(1, observed)); }
	void print(const char* name) const
	{
		std::cout << "[measured] " << name << ": observed " << observed << ", value over truth " << relative / std::max(1, observed)
		          << ", pull mean " << mean() << ", rms " << rms() << ", truth beyond the limit " << beyond_limit << "\n";
	}
};

constexpr int kSeries = 60;

TEST(AllanFit, WhiteNoiseComesBackWithinItsDeviation)
{
	Pulls white;
	int walks = 0, quantisations = 0;
	for (unsigned s = 0; s < kSeries; ++s)
	{
		const NoiseModel m = fitted({0, 1.7e-4, 0, 0}, 400, s);
		white.add(m.white, 1.7e-4);
		walks += m.walk.observed ? 1 : 0;
		quantisations += m.quantisation.observed ? 1 : 0;
		if (!m.walk.observed)
		{
			EXPECT_GE(m.walk_needs_s, 2 * m.length_s);
		}
	}
	white.print("N of white noise");
	std::cout << "[measured] walks seen in white noise: " << walks << " of " << kSeries << ", quantisation: " << quantisations << "\n";
	EXPECT_EQ(white.observed, kSeries);
	EXPECT_LT(white.rms(), 1.5);
	EXPECT_GT(white.rms(), 0.4);
	EXPECT_NEAR(white.relative / kSeries, 1, 0.005);
	EXPECT_LE(walks, kSeries / 15);
	EXPECT_LE(quantisations, kSeries / 15);
}

TEST(AllanFit, ARandomWalkOfTheBiasComesBackWhereTheLogIsLongEnough)
{
	const NoiseDensities truth{0, 1.6e-3, 0, 2e-4};
	Pulls white, walk, short_walk;
	for (unsigned s = 0; s < kSeries; ++s)
	{
		const NoiseModel m = fitted(truth, 1200, 100 + s);
		white.add(m.white, truth.N);
		walk.add(m.walk, truth.K);
		short_walk.add(fitted(truth, 20, 200 + s).walk, truth.K);
	}
	white.print("N beside a walk");
	walk.print("K, 1200 s");
	short_walk.print("K, 20 s");
	EXPECT_GE(walk.observed, kSeries - 2);
	EXPECT_LT(walk.rms(), 1.5);
	EXPECT_NEAR(walk.relative / walk.observed, 1, 0.05);
	EXPECT_LT(white.rms(), 1.5);
	EXPECT_LE(short_walk.observed, kSeries / 6);
	EXPECT_LE(short_walk.beyond_limit, kSeries / 6);
}

TEST(AllanFit, QuantisationBendsTheShortEndAndLeavesTheWhiteNoise)
{
	const NoiseDensities truth{2e-4, 1e-3, 0, 0};
	Pulls quantisation, white;
	for (unsigned s = 0; s < kSeries; ++s)
	{
		const NoiseModel m = fitted(truth, 400, 300 + s);
		quantisation.add(m.quantisation, truth.Q);
		white.add(m.white, truth.N);
	}
	quantisation.print("Q");
	white.print("N beside Q");
	EXPECT_EQ(quantisation.observed, kSeries);
	EXPECT_LT(quantisation.rms(), 1.5);
	EXPECT_LT(white.rms(), 1.5);
	EXPECT_NEAR(quantisation.relative / kSeries, 1, 0.02);
	EXPECT_NEAR(white.relative / kSeries, 1, 0.01);
}

TEST(AllanFit, TheFlatPartIsTheBiasInstability)
{
	const NoiseDensities truth{0, 2e-4, 1e-4, 0};
	Pulls white;
	double instability = 0;
	int reached = 0;
	for (unsigned s = 0; s < kSeries / 2; ++s)
	{
		const NoiseModel m = fitted(truth, 1000, 400 + s);
		white.add(m.white, truth.N);
		reached += m.instability.reached ? 1 : 0;
		instability += m.instability.value / (kSeries / 2);
	}
	white.print("N beside flicker");
	std::cout << "[measured] bias instability: reached " << reached << " of " << kSeries / 2 << ", mean over truth "
	          << instability / truth.B << "\n";
	EXPECT_LT(white.rms(), 1.6);
	EXPECT_GE(reached, kSeries / 3);
	EXPECT_NEAR(instability / truth.B, 1, 0.2);
}

/** As of a sensor's low-pass filter: the mean of four neighbours has the same density, but too little at the short end. */
TEST(AllanFit, SmoothedSamplesAreLeftOut)
{
	Pulls white;
	for (unsigned s = 0; s < kSeries / 2; ++s)
	{
		const std::vector<double> raw = noiseSeries({0, 1e-3, 0, 0}, kInterval_s / 2, 80000, 500 + s);
		std::vector<double> smooth(raw.size());
		double state = 0;
		for (size_t i = 0; i < raw.size(); ++i) smooth[i] = state += 0.4 * (raw[i] - state);
		const NoiseModel m = fitNoise(allanCurve({smooth}, kInterval_s / 2));
		EXPECT_TRUE(m.smoothed);
		white.add(m.white, 1e-3);
	}
	white.print("N of smoothed samples");
	EXPECT_NEAR(white.relative / white.observed, 1, 0.03);
	EXPECT_LT(white.rms(), 3);
}

TEST(AllanFit, NinetyFivePercentOfTheIntervalsHoldTheTruth)
{
	int inside = 0, all = 0;
	for (unsigned s = 0; s < kSeries; ++s)
		for (const FittedPoint& p : fitted({0, 1e-3, 0, 0}, 100, 600 + s).points)
		{
			const double truth = 1e-3 / std::sqrt(p.point.tau_s);
			inside += p.low <= truth && truth <= p.high ? 1 : 0;
			++all;
		}
	const double share = static_cast<double>(inside) / all;
	std::cout << "[measured] the truth lies in the interval at " << 100 * share << " % of the points\n";
	EXPECT_GT(share, 0.9);
	EXPECT_LT(share, 0.99);
}

TEST(AllanFit, ARampHasTheSlopeOfADrift)
{
	std::vector<double> x = noiseSeries({0, 1e-3, 0, 0}, kInterval_s, 50000, 7);
	for (size_t i = 0; i < x.size(); ++i) x[i] += 2e-6 * static_cast<double>(i);
	EXPECT_GT(fitNoise(allanCurve({x}, kInterval_s)).trend_slope, 0.8);
	EXPECT_LT(fitted({0, 1e-3, 0, 1e-4}, 1000, 8).trend_slope, 0.8);
}

TEST(AllanFit, TooFewSamplesOrNoNoiseAreErrors)
{
	expectError([] { fitted({0, 1, 0, 0}, 1, 1); }, {"too few samples"});
	expectError([] { fitNoise(allanCurve({std::vector<double>(5000, 9.81)}, kInterval_s)); }, {"never change"});
}
}  // namespace
}  // namespace viwo::testing
