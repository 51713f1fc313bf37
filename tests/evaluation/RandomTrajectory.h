#pragma once

#include <viwo/core/Time.h>
#include <viwo/core/Trajectory.h>

#include <cmath>
#include <random>

namespace viwo::testing
{
inline Eigen::Vector3d randomVector(std::mt19937_64& random, double sigma)
{
	std::normal_distribution<double> normal(0, sigma);
	const double x = normal(random), y = normal(random), z = normal(random);
	return {x, y, z};
}

inline Pose3 randomPose(std::mt19937_64& random, double sigma_m, double sigma_rad)
{
	const Eigen::Vector3d phi = randomVector(random, sigma_rad);
	return {Eigen::Quaterniond(Eigen::AngleAxisd(phi.norm(), phi.normalized())), randomVector(random, sigma_m)};
}

/** A winding drive in three dimensions at `rate_hz` for `duration_s`, starting at a present-day Unix time. */
inline Trajectory windingDrive(double rate_hz, double duration_s, double offset_s = 0)
{
	Trajectory drive;
	const int count = static_cast<int>(std::lround(duration_s * rate_hz));
	for (int i = 0; i <= count; ++i)
	{
		const double t = i / rate_hz + offset_s;
		const Eigen::Vector3d p(2 * std::sin(0.3 * t) + 0.1 * t, 1.5 * std::sin(0.41 * t + 0.5), 0.2 * std::sin(0.7 * t));
		const Eigen::Quaterniond R =
		    Eigen::AngleAxisd(0.2 * t, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.05 * std::sin(t), Eigen::Vector3d::UnitY());
		drive.push_back({1700000000000000000 + nanoseconds(t), Pose3(R, p)});
	}
	return drive;
}

/** Each pose replaced by f(pose). */
template <class Function>
Trajectory transformed(const Trajectory& trajectory, const Function& f)
{
	Trajectory result;
	for (const StampedPose& pose : trajectory.poses()) result.push_back({pose.t_ns, f(pose.T)});
	return result;
}
}  // namespace viwo::testing
