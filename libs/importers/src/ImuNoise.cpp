#include "ImuNoise.h"

#include <mrpt/core/format.h>

#include <cmath>

#include "YamlMap.h"

namespace viwo
{
std::string doubtOnNoise(const std::string& where, double density, double least, double most, double rate_hz)
{
	if (density >= least && density <= most) return {};
	const double as_density = rate_hz > 0 ? density / std::sqrt(rate_hz) : 0;
	if (density > most && as_density >= least && as_density <= most)
		return where + mrpt::format(" = %g looks like the deviation of single samples; as a density at %g Hz it would be %.3g", density,
		                            rate_hz, as_density);
	return where + mrpt::format(" = %g is not what an IMU has (%g to %g); check its unit", density, least, most);
}

RigImu readKalibrImu(const std::string& path, std::vector<std::string>& warnings)
{
	const YamlMap file = YamlMap::load(path);
	const YamlMap yaml = file.map("imu0").value_or(file);
	const double rate_hz = yaml.optionalNumber("update_rate").value_or(0);
	/** From tactical grade to the cheapest MEMS, with a factor of a few, for many give more than the data sheet to cover vibration. */
	struct Density
	{
		const char* key;
		double RigImu::*value;
		double least, most;
	};
	const Density densities[] = {{"accelerometer_noise_density", &RigImu::acc_noise_m_s2_sqrtHz, 1e-5, 1.5e-2},
	                             {"gyroscope_noise_density", &RigImu::gyro_noise_rad_s_sqrtHz, 5e-7, 2e-3},
	                             {"accelerometer_random_walk", &RigImu::acc_walk_m_s3_sqrtHz, 1e-7, 1e-2},
	                             {"gyroscope_random_walk", &RigImu::gyro_walk_rad_s2_sqrtHz, 1e-9, 1e-3}};
	RigImu imu;
	for (const Density& d : densities)
	{
		const double value = yaml.number(d.key);
		if (!std::isfinite(value) || value <= 0) yaml.fail(d.key, "not a number above 0");
		imu.*d.value = value;
		if (const std::string doubt = doubtOnNoise(path + ": " + d.key, value, d.least, d.most, rate_hz); !doubt.empty())
			warnings.push_back(doubt);
	}
	return imu;
}
}  // namespace viwo
