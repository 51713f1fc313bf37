#include "MountingCheck.h"

#include <mrpt/core/format.h>
#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Ranking.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
/** No robot on wheels accelerates by so much for seconds: sqrt(g^2 + a^2) is 1.3 g at 0.8 g. */
constexpr double kOffGravity = 0.3;
/** Beyond any slope and any acceleration of a robot on wheels. */
constexpr double kOffVertical_deg = 30;
constexpr size_t kFewestSamples = 10;
const char* const kRemedy = "rawlog-edit --sensors-pose, or in a rig.ini (--rig)";
}  // namespace

void MountingCheck::add(const mrpt::obs::CObservationImage& image) const
{
	if (image.cameraPose == mrpt::poses::CPose3D())
		throw Error("label " + image.sensorLabel +
		            ": cameraPose is identity, MRPT's default, which lets the camera look straight up from O; set it with " + kRemedy);
}

void MountingCheck::add(const mrpt::obs::CObservationIMU& imu)
{
	const Eigen::Vector3d f(imu.get(mrpt::obs::IMU_X_ACC), imu.get(mrpt::obs::IMU_Y_ACC), imu.get(mrpt::obs::IMU_Z_ACC));
	if (imu.has(mrpt::obs::IMU_X_ACC) && f.allFinite()) forces_O_m_s2_.push_back(fromMrpt(imu.sensorPose).R * f);
}

void MountingCheck::judge() const
{
	if (forces_O_m_s2_.size() < kFewestSamples) return;
	std::vector<double> norms;
	for (const auto& f : forces_O_m_s2_) norms.push_back(f.norm());
	const double median_m_s2 = upperMedian(norms);
	judgeSize(median_m_s2);
	if (options_.estimator.useWheels()) judgeDirection(median_m_s2);
}

void MountingCheck::judgeSize(double median_m_s2) const
{
	const double g_m_s2 = options_.estimator.noise.gravity_m_s2;
	if (std::abs(median_m_s2 - g_m_s2) <= kOffGravity * g_m_s2) return;
	const std::string readings = mrpt::format(": the accelerometer reads %.3g at the start, gravity is %.2f m/s^2; ", median_m_s2, g_m_s2);
	const char* const remedy = std::abs(median_m_s2 - 1) < kOffGravity ? "it seems to be in units of g: record specific force in m/s^2"
	                                                                   : "record specific force in m/s^2, gravity included";
	throw Error("label " + options_.rawlog.imu_label + readings + remedy);
}

void MountingCheck::judgeDirection(double median_m_s2) const
{
	Eigen::Vector3d sum = Eigen::Vector3d::Zero();
	for (const auto& f : forces_O_m_s2_)
		if (f.norm() < 2 * median_m_s2) sum += f;
	const double off_deg = std::acos(std::clamp(sum.normalized().z(), -1.0, 1.0)) * 180 / M_PI;
	if (!(off_deg > kOffVertical_deg)) return;
	throw Error(
	    "label " + options_.rawlog.imu_label +
	    mrpt::format(": by its sensorPose, gravity at the start is %.0f deg off the robot's vertical; set sensorPose with ", off_deg) +
	    kRemedy);
}
}  // namespace viwo
