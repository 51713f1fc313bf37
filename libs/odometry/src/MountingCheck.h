#pragma once

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <viwo/odometry/OdometryOptions.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace viwo
{
/** Whether the sensors' poses on the robot and the accelerometer's unit can be right, from the first seconds of a log: MRPT's defaults are
 *  identity, which puts a camera's optical axis straight up, and give no warning.
 */
class MountingCheck
{
   public:
	explicit MountingCheck(const OdometryOptions& options) : options_(options) {}

	/** @throws Error when the camera's pose is exactly identity. */
	void add(const mrpt::obs::CObservationImage& image) const;
	void add(const mrpt::obs::CObservationIMU& imu);

	/** @throws Error: specific force that is not of the size of gravity or, where wheels say what is up, not vertical. */
	void judge() const;

   private:
	void judgeSize(double median_m_s2) const;
	void judgeDirection(double median_m_s2) const;

	const OdometryOptions& options_;
	std::vector<Eigen::Vector3d> forces_O_m_s2_;
};
}  // namespace viwo
