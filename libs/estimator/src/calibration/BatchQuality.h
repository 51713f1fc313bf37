#pragma once

#include "LandmarkMap.h"
#include "calibration/BatchStates.h"

namespace viwo
{
/** What is left of the measurements at the present states. */
CalibrationQuality qualityOf(const BatchCalibrationInput& input, const BatchStates& states, const LandmarkMap& landmarks);
}  // namespace viwo
