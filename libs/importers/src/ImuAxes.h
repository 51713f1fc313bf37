#pragma once

#include <viwo/core/ImuSample.h>
#include <viwo/core/WheelSample.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

namespace viwo
{
struct StampedTwist
{
	int64_t t_ns = 0;
	WheelTwist twist;
};

inline bool isFinite(const ImuSample& sample)
{
	return sample.acc_m_s2.allFinite() && sample.gyro_rad_s.allFinite();
}

/** How an IMU of unknown mounting sits on its vehicle. */
struct ImuAxes
{
	Eigen::Quaterniond R_OB = Eigen::Quaterniond::Identity();  //!< maps each axis of B onto an axis of O
	Eigen::Vector3d mean_force_B_m_s2 = Eigen::Vector3d::Zero();
	double tilt_rad = 0;  //!< between the mean specific force and O's z axis, turned by R_OB
	/** Correlation of the forward acceleration with that of the odometry; nothing where the drive does not tell (no odometry, hardly any
	 * acceleration): then of the four headings the one of the smallest turn is taken. */
	std::optional<double> forward_correlation;
	std::optional<double> yaw_rate_correlation;  //!< of the turned gyroscope with the odometry's yaw rate
};

/** The mounting in steps of 90 degrees: up from the mean specific force, forward from the accelerations of the odometry.
 *  @param imu, odometry in increasing order of time, of level driving; samples that are not finite are skipped.
 *  @return nothing for fewer than ten IMU samples that are finite. */
std::optional<ImuAxes> guessImuAxes(const std::vector<ImuSample>& imu, const std::vector<StampedTwist>& odometry);
}  // namespace viwo
