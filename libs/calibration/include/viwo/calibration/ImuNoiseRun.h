#pragma once

#include <viwo/calibration/AllanFit.h>
#include <viwo/calibration/EvenImu.h>
#include <viwo/rawlog/RigFile.h>

#include <array>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace viwo
{
/** Which part of which IMU is taken. */
struct ImuNoiseOptions
{
	std::vector<std::string> rawlogs;  //!< of one IMU, in any order
	std::string imu_label = "IMU";
	double from_s = 0;  //!< from the IMU's first stamp
	double to_s = std::numeric_limits<double>::infinity();
};

/** One of the four densities of a rig: that of its worst axis. */
struct WorstAxis
{
	size_t axis = 0;  //!< of the six
	NoiseReading reading;
};

/** What was found, axis by axis. */
struct ImuNoiseResult
{
	std::string imu_label;
	Pose3 T_OB;  //!< as the rawlog has it
	double duration_s = 0, rate_hz = 0, jitter_s = 0, longest_gap_s = 0;
	size_t samples = 0, lost = 0, pieces = 0;
	std::map<std::string, uint64_t> rejected;  //!< samples by the reason (nameOf(Rejection))
	std::array<NoiseModel, kImuAxes> axes;
	std::array<double, kImuAxes> mean{};
	WorstAxis acc_noise, gyro_noise;
	WorstAxis acc_walk, gyro_walk;  //!< not observed where no axis shows one
	std::vector<std::string> warnings;

	/** The worst axes' noise for section [IMU] of a rig; what was not observed is left as it is. */
	void put(RigImu& imu) const;
	/** Label, mounting and noise. */
	RigImu rig() const;
};

/** Hooks of a run; all may be empty. */
struct ImuNoiseHooks
{
	std::function<void(double fraction, const std::string& note)> progress;
	std::function<bool()> interrupted;
};

/** Noise of an IMU that stands still, by its Allan deviation. @throws Error: no such IMU (naming those there are), no rates, too short, not
 * at rest for most of the time, interrupted. */
ImuNoiseResult estimateImuNoise(const ImuNoiseOptions& options, const ImuNoiseHooks& hooks = {});
}  // namespace viwo
