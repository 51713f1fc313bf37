#pragma once

#include <viwo/importers/ImportJob.h>

namespace viwo
{
/** A sequence in EuRoC's ASL layout (Burri et al., "The EuRoC micro aerial vehicle datasets", IJRR 2016) as a rawlog.
 *
 *  Reads mav0/cam0 and mav0/imu0 (data.csv, sensor.yaml with T_BS, pinhole intrinsics, radial-tangential or equidistant distortion), the
 *  truth in mav0/state_groundtruth_estimate0 if there, and, beyond EuRoC, wheel odometry in mav0/odom0/data.csv: `t[ns], v [m/s], yaw rate
 * [rad/s]`, with odom0/sensor.yaml whose T_BS is the odometer frame O in the body frame. Without it O = B. Image files are copied as they
 * are. The truth is that of O.
 *
 *  @param job its folder is that which holds mav0, or mav0 itself.
 *  @throws Error naming file and line: missing files, wrong columns, stamps that do not increase, unknown camera or distortion model.
 */
ImportResult importEuroc(const ImportJob& job);
}  // namespace viwo
