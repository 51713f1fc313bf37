#pragma once

#include "calibration/BatchStart.h"

namespace viwo
{
/** Cuts the samples at the key frames, at the clock offsets, sensitivities, biases and wheels of the states, and makes the factors of IMU
 * and wheels of every frame anew. @param wheel_noise_ratio factor on the wheels' configured white noise.
 */
void cutIntervals(const BatchSamples& samples, const EstimatorOptions& options, double wheel_noise_ratio, BatchStates& states);
}  // namespace viwo
