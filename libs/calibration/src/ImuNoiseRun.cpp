#include <viwo/calibration/ImuNoiseRun.h>
#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>
#include <viwo/core/ParallelFor.h>
#include <viwo/rawlog/RawlogReader.h>

#include <cmath>
#include <thread>

#include "ImuLog.h"
#include "RestCheck.h"

namespace viwo
{
namespace
{
constexpr double kLeast_s = 30;   // white noise at 1 s needs as much
constexpr double kShort_s = 600;  // below it the flat part of the curve is rarely reached
constexpr size_t kLeastSamples = 500;
constexpr double kMostDisturbed = 0.5;
constexpr double kManyLost = 0.01;
constexpr double kDrift = 0.8;  // slope of the curve's end
constexpr double kBadFit = 6;

void requireLength(const EvenImu& imu)
{
	const double length_s = imu.duration_s();
	if (length_s >= kLeast_s && imu.samples >= kLeastSamples) return;
	throw Error(fixed(length_s, 1) + " s of " + std::to_string(imu.samples) + " IMU samples are too short; " + fixed(kLeast_s, 0) +
	            " s show the white noise, ten minutes the bias instability, hours the random walk");
}

std::string list(const std::map<std::string, uint64_t>& counts)
{
	std::string text;
	for (const auto& [reason, count] : counts) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
	return text;
}

void warnOfStamps(const ImuLog& log, const EvenImu& imu, std::vector<std::string>& warnings)
{
	const size_t cells = imu.samples + imu.lost;
	if (log.truncated) warnings.emplace_back("the rawlog is truncated: this is of what could be read");
	if (!log.rejected.empty()) warnings.push_back("samples not used: " + list(log.rejected));
	if (static_cast<double>(imu.lost) > kManyLost * static_cast<double>(cells))
		warnings.push_back(std::to_string(imu.lost) + " of " + std::to_string(cells) + " samples are missing, the longest gap is " +
		                   fixed(imu.longest_gap_s, 2) + " s: clusters are averaged over the samples that are there");
	if (imu.pieces.size() > 1)
		warnings.push_back("gaps of more than ten minutes: " + std::to_string(imu.pieces.size()) +
		                   " pieces, the longest counts for long times");
	if (imu.jitter_s > 0.2 * imu.interval_s)
		warnings.push_back("stamps jitter by " + fixed(1e3 * imu.jitter_s, 2) + " ms: samples are taken to be " +
		                   fixed(1e3 * imu.interval_s, 3) + " ms apart");
}

void warnOfCurve(size_t axis, const NoiseModel& m, std::vector<std::string>& warnings)
{
	const std::string name = imuAxisName(axis);
	if (m.trend_slope > kDrift && m.walk.observed)
		warnings.push_back(name + ": the curve ends with slope " + fixed(m.trend_slope, 2) +
		                   ", which is a drift (temperature) and no random walk; its random walk is too large");
	if (m.misfit > kBadFit) warnings.push_back(name + ": the curve does not fit the noise of a sensor at rest; look at the plot");
}

WorstAxis worstOf(const std::array<NoiseModel, kImuAxes>& axes, size_t first, NoiseReading NoiseModel::*which)
{
	WorstAxis worst{first, axes[first].*which};
	for (size_t axis = first; axis < first + 3; ++axis)
	{
		const NoiseReading& r = axes[axis].*which;
		const bool more = r.observed ? !worst.reading.observed || r.value > worst.reading.value
		                             : !worst.reading.observed && r.limit > worst.reading.limit;
		if (more) worst = {axis, r};
	}
	return worst;
}

/** More than any deviation allows. */
double fourDigits(double value)
{
	const double unit = std::pow(10.0, std::floor(std::log10(value)) - 3);
	return std::round(value / unit) * unit;
}

double meanOf(const EvenPieces& pieces)
{
	double sum = 0;
	size_t count = 0;
	for (const auto& piece : pieces)
		for (const double x : piece)
			if (std::isfinite(x)) sum += x, ++count;
	return count > 0 ? sum / static_cast<double>(count) : 0;
}
EvenImu evenSamples(const std::string& where, ImuLog& log)
{
	try
	{
		EvenImu imu = evenlySampled(std::move(log.record));
		imu.log_start_ns = log.start_ns;
		requireLength(imu);
		return imu;
	}
	catch (const Error& e)
	{
		throw Error(where + ": " + e.what());
	}
}

/** An axis without noise (of a planar unit, say) is left out, and said. */
void fitAxes(const EvenImu& imu, ImuNoiseResult& result)
{
	std::array<std::string, kImuAxes> errors;
	const auto fit = [&](size_t axis)
	{
		try
		{
			result.mean[axis] = meanOf(imu.axes[axis]);
			result.axes[axis] = fitNoise(allanCurve(imu.axes[axis], imu.interval_s));
		}
		catch (const Error& e)
		{
			errors[axis] = std::string(imuAxisName(axis)) + " is left out: " + e.what();
		}
	};
	parallelFor(kImuAxes, static_cast<int>(std::thread::hardware_concurrency()), fit);
	for (size_t axis = 0; axis < kImuAxes; ++axis)
	{
		if (!errors[axis].empty()) result.warnings.push_back(errors[axis]);
		warnOfCurve(axis, result.axes[axis], result.warnings);
	}
}
}  // namespace

void ImuNoiseResult::put(RigImu& imu) const
{
	const auto set = [](double& key, const WorstAxis& worst)
	{
		if (worst.reading.observed) key = fourDigits(worst.reading.value);
	};
	set(imu.acc_noise_m_s2_sqrtHz, acc_noise);
	set(imu.gyro_noise_rad_s_sqrtHz, gyro_noise);
	set(imu.acc_walk_m_s3_sqrtHz, acc_walk);
	set(imu.gyro_walk_rad_s2_sqrtHz, gyro_walk);
}

RigImu ImuNoiseResult::rig() const
{
	RigImu imu;
	imu.mounting.label = imu_label;
	imu.mounting.setPose(T_OB);
	put(imu);
	return imu;
}

ImuNoiseResult estimateImuNoise(const ImuNoiseOptions& options, const ImuNoiseHooks& hooks)
{
	const std::string where = rawlogNames(options.rawlogs);
	ImuLog log = readImuLog(options, hooks);
	if (log.record.t_ns.size() < 2)
		throw Error(where + ": " + std::to_string(log.record.t_ns.size()) + " usable IMU samples between --from and --to" +
		            (log.rejected.empty() ? "" : " (not used: " + list(log.rejected) + ")"));
	EvenImu imu = evenSamples(where, log);

	ImuNoiseResult result;
	result.imu_label = options.imu_label;
	result.T_OB = log.T_OB;
	result.duration_s = imu.duration_s();
	result.rate_hz = 1 / imu.interval_s;
	result.jitter_s = imu.jitter_s;
	result.longest_gap_s = imu.longest_gap_s;
	result.samples = imu.samples;
	result.lost = imu.lost;
	result.pieces = imu.pieces.size();
	result.rejected = log.rejected;
	warnOfStamps(log, imu, result.warnings);

	const RestCheck check = checkRest(imu, log.driven);
	if (check.disturbed_share > kMostDisturbed)
		throw Error(where + ": not at rest for " + fixed(100 * check.disturbed_share, 0) +
		            " % of the time; record it standing still, or choose a part with --from and --to");
	result.warnings.insert(result.warnings.end(), check.warnings.begin(), check.warnings.end());
	if (result.duration_s < kShort_s)
		result.warnings.push_back("a log of " + fixed(result.duration_s, 0) + " s: good for the white noise; record hours for the rest");
	fitAxes(imu, result);
	result.acc_noise = worstOf(result.axes, 0, &NoiseModel::white);
	result.gyro_noise = worstOf(result.axes, 3, &NoiseModel::white);
	result.acc_walk = worstOf(result.axes, 0, &NoiseModel::walk);
	result.gyro_walk = worstOf(result.axes, 3, &NoiseModel::walk);
	if (!result.acc_noise.reading.observed || !result.gyro_noise.reading.observed)
		throw Error(where + ": no white noise is seen in the " + (result.acc_noise.reading.observed ? "rates" : "accelerations") +
		            ": not measured, not at rest, or of a resolution that hides it");
	return result;
}
}  // namespace viwo
