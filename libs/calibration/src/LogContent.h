#pragma once

#include <viwo/calibration/CalibrationRun.h>

namespace viwo
{
/** Samples of the log, and the tracks of its images; stamps as they are in the log. @throws Error */
BatchCalibrationInput readLog(const CalibrationRunOptions& options, const CalibrationRunHooks& hooks);
}  // namespace viwo
