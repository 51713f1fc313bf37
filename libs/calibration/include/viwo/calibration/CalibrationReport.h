#pragma once

#include <viwo/calibration/CalibrationRun.h>

#include <string>

namespace viwo
{
/** The table for a terminal, and how the residuals changed. */
std::string calibrationText(const CalibrationRunResult& result);

/** JSON: rawlog, parameters by name with start, value, deviation, unit, observed; residuals before and after. */
std::string calibrationJson(const CalibrationRunResult& result);

/** One page with everything in it. */
std::string calibrationHtml(const CalibrationRunResult& result);

/** rig.ini with the deviations in its head. @throws Error when it cannot be written. */
void saveCalibration(const CalibrationRunResult& result, const std::string& path);
}  // namespace viwo
