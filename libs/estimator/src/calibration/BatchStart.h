#pragma once

#include "SampleBuffer.h"
#include "calibration/BatchStates.h"

#include <string>

namespace viwo
{
/** The sample streams of a log, whole. */
struct BatchSamples
{
	explicit BatchSamples(const BatchCalibrationInput& input);

	ImuBuffer imu;
	WheelBuffer wheels;
};

/** Key frames of a log, with states from dead reckoning: the wheels' speed along the gyroscope's heading on level ground.
 *  @return empty, or what the log lacks for a calibration.
 */
std::string startBatch(const BatchCalibrationInput& input, const BatchCalibrationOptions& options, const EstimatorOptions& estimator,
                       const BatchSamples& samples, BatchStates& states);
}  // namespace viwo
