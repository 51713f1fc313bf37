#pragma once

#include <mrpt/obs/CObservationIMU.h>
#include <viwo/groundtruth/Pose2.h>

#include <cstdint>
#include <vector>

namespace viwo::gt
{
struct Scan;

/** Yaw by integration of a gyroscope. */
class InertialYaw
{
   public:
	void add(const mrpt::obs::CObservationIMU& imu);

	/** Sets Scan::gyro_yaw, the bias (median difference to odometry over spans of a second) taken off. @return false without use: no
	 * odometry to tell the bias, or too few readings. */
	bool integrate(std::vector<Scan>& scans, double& bias_rad_s) const;

	size_t leftOut() const { return left_out_; }  //!< readings that are no numbers, or none that a gyroscope measures

   private:
	struct Reading
	{
		int64_t t_ns;
		double rate_rad_s;  //!< about O's z axis
	};
	std::vector<Reading> readings_;
	size_t left_out_ = 0;
};
}  // namespace viwo::gt
