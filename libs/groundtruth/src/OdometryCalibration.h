#pragma once

#include "ScanSmoother.h"

namespace viwo::gt
{
/** What the finished trajectory says of the sensors. Fields are empty where the log does not tell. */
struct OdometryCalibration
{
	std::optional<double> distance_scale;  //!< way by scans over way by odometry
	std::optional<double> distance_scale_deviation;
	std::optional<double> distance_walk;    //!< standard deviation of a way by odometry around that scale, m per square root of a metre
	std::optional<double> turn_scale;       //!< turn by scans over turn by odometry: above 1 the track is taken too wide
	std::optional<double> lidar_yaw_rad;    //!< the lidar seems mounted this much to the left of what sensorPose says
	std::optional<double> gyro_bias_rad_s;  //!< on top of what was taken off on loading
	std::optional<double> time_offset_s;    //!< odometry's stamps plus this are the scans'
	std::optional<double> time_offset_deviation_s;

	/** Whether the offset is more than noise. */
	bool offsetIsSignificant() const
	{
		return time_offset_s && time_offset_deviation_s && std::abs(*time_offset_s) > 3 * *time_offset_deviation_s;
	}
};

/** @param poses of all scans; those that are not good are left out. */
OdometryCalibration calibrateOdometry(const Session& session, const std::vector<FinalPose>& poses);
}  // namespace viwo::gt
