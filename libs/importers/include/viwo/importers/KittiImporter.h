#pragma once

#include <viwo/importers/ImportJob.h>

#include <cstdint>

namespace viwo
{
/** Errors that are put on the drive's exact forward speed. */
struct KittiOptions
{
	double speed_noise_m_s = 0;  //!< standard deviation of white noise added to each forward speed
	double speed_scale = 1;      //!< factor on the forward speed, before the noise: a wrong wheel radius
	uint64_t seed = 1;
};

/** A drive in KITTI's raw layout (Geiger et al., "Vision meets robotics: the KITTI dataset", IJRR 2013) as a rawlog.
 *
 *  Reads image_00 and oxts (data/, timestamps.txt; stamps are taken as UTC), and calib_cam_to_cam, calib_velo_to_cam, calib_imu_to_velo in
 * the folder or the one above. Frames whose file is absent are left out and counted in the notes. The size of the first image tells whether
 * images are as recorded (K_00, D_00) or rectified (P_rect_00, R_rect_00).
 *
 *  OXTS gives the IMU (ax ay az, wx wy wz), and the wheel odometry: forward speed vf and yaw rate wz, which are values at their stamp, not
 * means. O lies on the ground straight below the IMU, 0.93 m under it, with the IMU's axes: there vf is the forward speed whatever the
 * car's yaw rate. The truth is O's pose in an east-north-up frame at the first position: Mercator projection of lat and lon as in KITTI's
 * development kit, alt, roll, pitch, yaw.
 *
 *  @throws Error naming file and line: missing files, wrong columns, stamps that do not increase.
 */
ImportResult importKitti(const ImportJob& job, const KittiOptions& options);
}  // namespace viwo
