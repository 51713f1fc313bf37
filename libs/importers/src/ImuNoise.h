#pragma once

#include <viwo/rawlog/RigFile.h>

#include <string>
#include <vector>

namespace viwo
{
/** Kalibr's imu.yaml; noise that no IMU has is kept, and told. @throws Error naming file and key. */
RigImu readKalibrImu(const std::string& path, std::vector<std::string>& warnings);

/** One line where the density is not one that an IMU of a robot can have, "" where it is; one that would be plausible once divided by the
 * square root of the rate is taken for the deviation of single samples.
 *  @param least, most of all IMUs from tactical grade to the cheapest.
 */
std::string doubtOnNoise(const std::string& where, double density, double least, double most, double rate_hz);
}  // namespace viwo
