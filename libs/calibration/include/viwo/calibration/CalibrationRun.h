#pragma once

#include <viwo/estimator/BatchCalibration.h>
#include <viwo/odometry/OdometryOptions.h>
#include <viwo/rawlog/RigFile.h>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace viwo
{
/** What viwo-calibrate estimate can be told. */
struct CalibrationRunOptions
{
	std::vector<std::string> rawlogs;  //!< of one drive, in the order of their time
	double from_s = 0;                 //!< from the first stamp of the labels in use
	double to_s = std::numeric_limits<double>::infinity();
	std::string reference;                 //!< TUM, poses of O; empty: none
	std::shared_ptr<const RigFile> start;  //!< counts instead of the rawlog's sensors; null: those
	OdometryOptions odometry;
	BatchCalibrationOptions calibration;

	/** The sections of viwo-odometry's configuration and [calibration]. */
	std::vector<OptionsSection> sections();
};

/** Hooks of a run; both may be empty. */
struct CalibrationRunHooks
{
	std::function<void(double fraction, const std::string& note)> progress;
	std::function<bool()> interrupted;
};

/** One line of the results. */
struct CalibrationRow
{
	std::string key;   //!< of RigOrder::names()
	std::string what;  //!< in words
	std::string unit;
	double start = 0, value = 0, deviation = 0;  //!< turns: by how much it is turned against the start
	bool observed = false;
};

/** What viwo-calibrate estimate prints and writes. */
struct CalibrationRunResult
{
	BatchCalibrationResult batch;
	SensorRig start;
	RigFile rig;  //!< what was found; camera model and noise as they were
	std::vector<CalibrationRow> rows;
	std::string rawlogs, reference;
	double from_s = 0;  //!< where the part that was used begins, as in the options
	double duration_s = 0, wall_time_s = 0;
};

/** Estimates a robot's calibration from a rawlog. @throws Error with one line for the user: what, where, remedy. */
CalibrationRunResult runCalibration(const CalibrationRunOptions& options, const CalibrationRunHooks& hooks = {});
}  // namespace viwo
