#pragma once

#include <viwo/odometry/OdometryRun.h>

#include <functional>

namespace viwo
{
/** Looks into a rawlog, no further than needed, for what would otherwise be told too late or never.
 *  @param interrupted the look ends, with nothing told, when it says so; may be empty.
 *  @throws Error: no observation of a sensor that the mode needs (it lists the labels there are); sensors on different clocks; an IMU no
 * faster than the camera; sensor poses that were never set; several rawlogs in another order than that of their time; an accelerometer that
 * does not read m/s^2; an image mask that is not there.
 */
void checkInput(const OdometryRunOptions& options, const std::function<bool()>& interrupted = {});
}  // namespace viwo
