#pragma once

#include "calibration/BatchProblem.h"

#include <Eigen/Core>
#include <vector>

namespace viwo
{
using RigFlags = Eigen::Matrix<bool, RigOrder::size, 1>;

/** What is known of the rig beforehand, in RigOrder; 0 for the height of the IMU, which is given. */
RigVector priorDeviations(const BatchCalibrationOptions& options, const SensorRig& start);

/** The start as a prior. @param held parameters that stay where the start has them. */
std::vector<BatchFactor> rigPriors(const SensorRig& start, const BatchCalibrationOptions& options, const RigFlags& held,
                                   BatchStates& states);
}  // namespace viwo
