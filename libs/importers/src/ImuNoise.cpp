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

namespace
{
/** Entries of the matrices M of Kalibr's intrinsic models against those of the identity. */
double largestOfM(const YamlMap& imu)
{
	double largest = 0;
	for (const char* triad : {"accelerometers", "gyroscopes"})
	{
		const auto sensor = imu.map(triad);
		const YAML::Node M = sensor ? (*sensor)["M"] : YAML::Node();
		if (!M || !M.IsSequence()) continue;
		for (size_t row = 0; row < M.size(); ++row)
		{
			const std::vector<double> values = sensor->numbers("M", M[row], 3, 3);
			for (size_t column = 0; column < 3; ++column) largest = std::max(largest, std::abs(values[column] - (row == column ? 1 : 0)));
		}
	}
	return largest;
}

/** Kalibr calibrates the IMU's axes as well where it is asked to. */
void warnOfModel(const YamlMap& imu, std::vector<std::string>& warnings)
{
	const std::string model = imu["model"] ? imu.word("model") : imu.map("accelerometers") ? "scale-misalignment" : "calibrated";
	if (model == "calibrated") return;
	warnings.push_back(imu.path() + mrpt::format(": model: %s: only the noise is taken; scale and misalignment of its axes (matrices M, up "
	                                             "to %.3g from the identity) are not applied: correct the samples in the driver",
	                                             model.c_str(), largestOfM(imu)));
}
}  // namespace

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
	warnOfModel(yaml, warnings);
	return imu;
}
}  // namespace viwo
