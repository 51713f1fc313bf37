#pragma once

#include <viwo/estimator/BatchCalibration.h>

#include <viwo/experiments/Recipes.h>
#include "Group.h"

namespace viwo::accuracy
{
/** Two minutes of starts, stops, turns both ways and figures of eight; the clocks of camera and wheels are off. */
SimulatedDrive calibrationDrive();

/** The rig as it is, of the drive's simulation. */
SensorRig trueRig(const SimulatedDrive& drive, uint64_t seed);

/** What a careless user believes: the scale of the wheels off by 2 %, the track by 3 %, both mountings by 2 cm and 1 degree on every axis
 *  (but the height of the IMU, which no motion on a floor tells), both clocks by 20 ms; the seed draws the signs. */
SensorRig wrongRig(const SensorRig& truth, uint64_t seed);

/** Saves a rig for the drive's log as <folder>/rigs/<name>.ini. @return its path. */
std::string saveRig(const Settings& settings, const SimulatedDrive& drive, const SensorRig& rig, const std::string& name);

/** The rig of a file, as saved above or by viwo-calibrate. @throws Error for a file without camera, IMU or wheels. */
SensorRig loadRig(const std::string& path);
}  // namespace viwo::accuracy
