#pragma once

#include <viwo/odometry/OdometryRun.h>

namespace viwo
{
/** Looks into a rawlog, no further than needed, for what would otherwise be told too late or never.
 *  @throws Error: no observation of a sensor that the mode needs (it lists the labels there are); an IMU no faster than the camera.
 */
void checkInput(const OdometryRunOptions& options);
}  // namespace viwo
