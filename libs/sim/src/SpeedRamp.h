#pragma once

#include <algorithm>

namespace viwo::sim
{
/** A factor that goes from `from` to 1, holds, and goes to `to`, by quintic smoothsteps: twice continuously differentiable, with its
 * integral. */
struct SpeedRamp
{
	double up_s = 0, hold_s = 0, down_s = 0;
	double from = 0, to = 0;

	/** Largest slope of a smoothstep of unit height and duration. */
	static constexpr double kPeakSlope = 1.875;

	struct Value
	{
		double f, d, dd, integral;
	};

	double duration_s() const { return up_s + hold_s + down_s; }
	double integral() const { return upIntegral() + hold_s + 0.5 * (1 + to) * down_s; }

	Value at(double t_s) const
	{
		if (t_s < up_s) return step(t_s, up_s, from, 1, 0);
		if (t_s <= up_s + hold_s || down_s == 0) return {1, 0, 0, upIntegral() + t_s - up_s};
		return step(t_s - up_s - hold_s, down_s, 1, to, upIntegral() + hold_s);
	}

   private:
	double upIntegral() const { return 0.5 * (1 + from) * up_s; }

	static Value step(double t_s, double duration_s, double a, double b, double integral_before)
	{
		const double x = std::clamp(t_s / duration_s, 0.0, 1.0), c = b - a;
		const double s = x * x * x * (10 + x * (-15 + 6 * x));
		const double s1 = 30 * x * x * (1 - x) * (1 - x) / duration_s;
		const double s2 = 60 * x * (1 - x) * (1 - 2 * x) / (duration_s * duration_s);
		const double integral = x * x * x * x * (2.5 + x * (-3 + x)) * duration_s;
		return {a + c * s, c * s1, c * s2, integral_before + a * t_s + c * integral};
	}
};
}  // namespace viwo::sim
