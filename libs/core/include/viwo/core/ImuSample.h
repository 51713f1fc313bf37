#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace viwo
{
/** One IMU reading, in the body frame B. */
struct ImuSample
{
	int64_t t_ns = 0;
	Eigen::Vector3d acc_m_s2 = Eigen::Vector3d::Zero();  //!< specific force: +|g| upwards at rest
	Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
};

/** Continuous-time noise densities of an IMU (the units of Kalibr's imu.yaml). */
struct ImuNoise
{
	double acc_noise_m_s2_sqrtHz = 2e-3;
	double gyro_noise_rad_s_sqrtHz = 2e-4;
	double acc_walk_m_s3_sqrtHz = 2e-4;
	double gyro_walk_rad_s2_sqrtHz = 1e-5;
};
}  // namespace viwo
