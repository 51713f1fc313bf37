#pragma once

#include <cmath>
#include <random>
#include <vector>

namespace viwo::testing
{
/** Densities of the noise of one axis, in the unit u of its samples; the same letters as in IEEE Std 952. */
struct NoiseDensities
{
	double Q = 0;  //!< u s: quantisation of the integral
	double N = 0;  //!< u/sqrt(Hz)
	double B = 0;  //!< u: flicker
	double K = 0;  //!< u sqrt(Hz)
};

/** Flicker of bias instability B: Gauss-Markov processes half a decade apart, each with the same variance, whose sum has a density of
 * nearly 1/f. */
class FlickerSource
{
   public:
	FlickerSource(double B, double interval_s, double longest_s)
	{
		// Processes a factor c apart in time, each of variance s^2, sum up to a density of B^2/(2 pi f) with s^2 = B^2 ln(c) / pi * pi/2.
		const double c = std::sqrt(10.0);
		for (double tau_s = interval_s; tau_s < 10 * longest_s; tau_s *= c)
		{
			decay_.push_back(std::exp(-interval_s / tau_s));
			state_.push_back(0);
		}
		deviation_ = B * std::sqrt(std::log(c) / M_PI);
	}
	template <class Generator>
	double next(Generator& generator)
	{
		double sum = 0;
		for (size_t i = 0; i < decay_.size(); ++i)
		{
			state_[i] = decay_[i] * state_[i] + deviation_ * std::sqrt(1 - decay_[i] * decay_[i]) * normal_(generator);
			sum += state_[i];
		}
		return sum;
	}
	template <class Generator>
	void start(Generator& generator)
	{
		for (double& x : state_) x = deviation_ * normal_(generator);
	}

   private:
	std::vector<double> decay_, state_;
	double deviation_ = 0;
	std::normal_distribution<double> normal_;
};

inline std::vector<double> noiseSeries(const NoiseDensities& d, double interval_s, size_t count, unsigned seed)
{
	std::mt19937_64 generator(seed);
	std::normal_distribution<double> normal;
	FlickerSource flicker(d.B, interval_s, interval_s * static_cast<double>(count));
	flicker.start(generator);
	std::vector<double> samples(count);
	const double root_s = std::sqrt(interval_s);
	double walk = 0, before = 0;
	for (double& x : samples)
	{
		walk += d.K * root_s * normal(generator);
		x = walk + d.N / root_s * normal(generator);
		if (d.B > 0) x += flicker.next(generator);
		if (d.Q > 0)
		{
			// Of the integral, read with an error of variance Q^2 each time: the rate has the difference of two of them.
			const double now = d.Q * normal(generator);
			x += (now - before) / interval_s;
			before = now;
		}
	}
	return samples;
}
}  // namespace viwo::testing
