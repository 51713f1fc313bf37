#include <viwo/core/Error.h>
#include <viwo/sim/Disturbances.h>
#include <viwo/sim/RandomSource.h>

#include <cmath>

#include "TimeJet.h"

namespace viwo::sim
{
namespace
{
constexpr int kFloorWaves = 16;
constexpr int kVibrationWaves = 7;  // per axis

double uniform(std::mt19937_64& generator, double low, double high)
{
	return std::uniform_real_distribution<double>(low, high)(generator);
}
double logUniform(std::mt19937_64& generator, double low, double high)
{
	return std::exp(uniform(generator, std::log(low), std::log(high)));
}
}  // namespace

FloorOptions FloorOptions::flat()
{
	FloorOptions o;
	o.height_rms_mm = 0;
	return o;
}

VibrationOptions VibrationOptions::off()
{
	VibrationOptions o;
	o.acceleration_m_s2 = o.rate_deg_s = 0;
	return o;
}

Floor::Floor(const FloorOptions& options, uint64_t seed)
{
	if (options.wavelength_min_m > options.wavelength_max_m)
		throw Error("[floor] wavelength_min_m is greater than wavelength_max_m; swap them");
	if (options.height_rms_mm == 0) return;
	std::mt19937_64 generator = randomSource(seed, "floor");
	for (int i = 0; i < kFloorWaves; ++i)
	{
		const double k_rad_m = 2 * M_PI / logUniform(generator, options.wavelength_min_m, options.wavelength_max_m);
		const double direction_rad = uniform(generator, 0, 2 * M_PI);
		const double amplitude_m = 1e-3 * options.height_rms_mm * std::sqrt(2.0 / kFloorWaves);
		waves_.push_back(
		    {amplitude_m, k_rad_m * std::cos(direction_rad), k_rad_m * std::sin(direction_rad), uniform(generator, 0, 2 * M_PI)});
	}
}

void Floor::at(const TimeJet& x, const TimeJet& y, TimeJet& height, TimeJet& slope_x, TimeJet& slope_y) const
{
	height = slope_x = slope_y = TimeJet();
	for (const Wave& w : waves_)
	{
		const TimeJet phase = w.kx_rad_m * x + w.ky_rad_m * y + w.phase_rad;
		const TimeJet slope = w.amplitude_m * cos(phase);
		height = height + w.amplitude_m * sin(phase);
		slope_x = slope_x + w.kx_rad_m * slope;
		slope_y = slope_y + w.ky_rad_m * slope;
	}
}

Vibration::Vibration(const VibrationOptions& options, uint64_t seed) : reference_speed_m_s_(options.reference_speed_m_s)
{
	if (options.frequency_min_hz > options.frequency_max_hz)
		throw Error("[vibration] frequency_min_hz is greater than frequency_max_hz; swap them");
	if (options.acceleration_m_s2 == 0 && options.rate_deg_s == 0) return;
	std::mt19937_64 generator = randomSource(seed, "vibration");
	for (int axis = 0; axis < 6; ++axis)
		for (int i = 0; i < kVibrationWaves; ++i)
		{
			const double omega_rad_s = 2 * M_PI * logUniform(generator, options.frequency_min_hz, options.frequency_max_hz);
			const double rms = std::sqrt(2.0 / kVibrationWaves);
			const double amplitude = axis < 3 ? rms * options.acceleration_m_s2 / (omega_rad_s * omega_rad_s)
			                                  : rms * options.rate_deg_s * M_PI / 180 / omega_rad_s;
			waves_.push_back({axis, amplitude, omega_rad_s, uniform(generator, 0, 2 * M_PI)});
		}
}

void Vibration::at(double t_s, const TimeJet& speed_squared, TimeJet (&displacement)[6]) const
{
	for (TimeJet& d : displacement) d = TimeJet();
	// |v| is not smooth at a standstill: v^2 / sqrt(v^2 + v0^2) is, and agrees with it well above v0.
	const double v0 = 0.1 * reference_speed_m_s_;
	const TimeJet scale = speed_squared * inverseSqrt(speed_squared + v0 * v0) * (1 / reference_speed_m_s_);
	for (const Wave& w : waves_)
	{
		const TimeJet phase(w.omega_rad_s * t_s + w.phase_rad, w.omega_rad_s, 0);
		displacement[w.axis] = displacement[w.axis] + w.amplitude * (scale * sin(phase));
	}
}
}  // namespace viwo::sim
