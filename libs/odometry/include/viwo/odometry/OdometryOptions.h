#pragma once

#include <viwo/estimator/EstimatorOptions.h>
#include <viwo/frontend/TrackerOptions.h>
#include <viwo/rawlog/ObservationAdapter.h>
#include <viwo/rawlog/RigFile.h>

#include <string>
#include <vector>

namespace viwo
{
/** Everything that viwo-odometry can be told by a configuration file. */
struct OdometryOptions
{
	AdapterOptions rawlog;
	TrackerOptions tracker;
	EstimatorOptions estimator;

	/** Without images for this long, poses are given from IMU and wheels at kBlindPeriod_s. */
	static constexpr double kBlindAfter_s = 0.35;
	static constexpr double kBlindPeriod_s = 0.1;
	/** Where no sensor at all has data, poses without any are given for this long at most. */
	static constexpr double kLongestBlind_s = 10;
	/** An observation whose stamp is farther than this from the stream is left out; see StampGate. */
	static constexpr double kMaxStampJump_s = 60;
	/** How long an image waits for IMU and wheel samples that reach up to it, by the log's clock. */
	static constexpr double kMaxWait_s = 0.3;

	/** The sections [rawlog], [tracker], [factors], [noise], [priors], [window], [initializer]. */
	std::vector<OptionsSection> sections();

	/** @throws Error that names file, section and key. */
	void load(const std::string& ini_path) { loadOptions(ini_path, sections()); }

	/** Takes noise, clock offsets and wheels from a rig; what it does not know stays. Its camera and mountings count where rawlogs are
	 * read.
	 *  @throws Error where its labels are not those of section [rawlog]. */
	void use(const RigFile& rig);
};
}  // namespace viwo
