#include "InertialYaw.h"

#include "Session.h"

#include <viwo/core/MrptPose.h>
#include <viwo/core/Ranking.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>

#include <algorithm>

namespace viwo::gt
{
namespace
{
constexpr double kLongestGap_s = 0.1;
constexpr size_t kFewest = 50;
constexpr double kFastest_rad_s = 100;  //!< no gyroscope measures more
}  // namespace

void InertialYaw::add(const mrpt::obs::CObservationIMU& imu)
{
	if (!imu.has(mrpt::obs::IMU_WX) || !imu.has(mrpt::obs::IMU_WY) || !imu.has(mrpt::obs::IMU_WZ)) return;
	const Eigen::Vector3d w(imu.get(mrpt::obs::IMU_WX), imu.get(mrpt::obs::IMU_WY), imu.get(mrpt::obs::IMU_WZ));
	const int64_t t_ns = nanosecondsOf(imu.timestamp);
	if (!readings_.empty() && t_ns <= readings_.back().t_ns) return;
	const double rate_rad_s = (fromMrpt(imu.sensorPose).R * w).z();
	if (!w.allFinite() || !(std::abs(rate_rad_s) < kFastest_rad_s))
		++left_out_;
	else
		readings_.push_back({t_ns, rate_rad_s});
}

bool InertialYaw::integrate(std::vector<Scan>& scans, double& bias_rad_s) const
{
	if (readings_.size() < kFewest) return false;
	size_t i = 0;
	double yaw = 0;
	for (Scan& scan : scans)
	{
		// Trapezoids up to the last reading before the scan; the rest of the way at the rate of the reading behind it.
		while (i + 1 < readings_.size() && readings_[i + 1].t_ns <= scan.t_ns)
		{
			yaw += 0.5 * (readings_[i].rate_rad_s + readings_[i + 1].rate_rad_s) * secondsBetween(readings_[i].t_ns, readings_[i + 1].t_ns);
			++i;
		}
		const bool inside = readings_[i].t_ns <= scan.t_ns && i + 1 < readings_.size() &&
		                    secondsBetween(readings_[i].t_ns, readings_[i + 1].t_ns) <= kLongestGap_s;
		if (inside) scan.gyro_yaw = yaw + readings_[i].rate_rad_s * secondsBetween(readings_[i].t_ns, scan.t_ns);
	}

	std::vector<double> differences;
	for (size_t a = 0, b = 0; a < scans.size(); a = std::max(a + 1, b))
	{
		while (b < scans.size() && secondsBetween(scans[a].t_ns, scans[b].t_ns) < 1) ++b;
		if (b == scans.size()) break;
		if (!scans[a].gyro_yaw || !scans[b].gyro_yaw || !scans[a].odometry || !scans[b].odometry) continue;
		const double turn = wrapped(scans[b].odometry->yaw - scans[a].odometry->yaw);
		differences.push_back(wrapped(*scans[b].gyro_yaw - *scans[a].gyro_yaw - turn) / secondsBetween(scans[a].t_ns, scans[b].t_ns));
	}
	if (differences.size() < 3)
	{
		for (Scan& scan : scans) scan.gyro_yaw.reset();
		return false;
	}
	bias_rad_s = upperMedian(differences);
	for (Scan& scan : scans)
		if (scan.gyro_yaw) *scan.gyro_yaw -= bias_rad_s * secondsBetween(scans.front().t_ns, scan.t_ns);
	return true;
}
}  // namespace viwo::gt
