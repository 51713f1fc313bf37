#include "ScanCloud.h"

#include <algorithm>

namespace viwo::gt
{
namespace
{
constexpr int kMaxBeams = 25;  //!< on either side in a fit

struct Beam
{
	Eigen::Vector2d p;
	double range_m;
	size_t index;
};

std::vector<Beam> beamsOf(const Scan& scan, const ScanOptions& options, const Twist2& twist)
{
	std::vector<Beam> beams;
	const double n = static_cast<double>(scan.ranges_m.size() - 1);
	const Eigen::Matrix3d R_OL = scan.T_OL.R.toRotationMatrix();
	for (size_t i = 0; i < scan.ranges_m.size(); ++i)
	{
		const double r = static_cast<double>(scan.ranges_m[i]);
		const double angle = scan.first_angle_rad + scan.step_rad * static_cast<double>(i);
		if (r <= 0) continue;
		const Eigen::Vector3d in_O = R_OL * Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0) + scan.T_OL.p;
		const double dt_s = options.scan_duration_s * (static_cast<double>(i) / n - options.stamp_position);
		const Pose2 T_at_beam(twist.v * dt_s, twist.w_rad_s * dt_s);
		beams.push_back({T_at_beam * in_O.head<2>(), r, i});
	}
	return beams;
}

/** Normal of the line through the neighbours of beam k, towards the sensor; zero where they are few or no line. */
Eigen::Vector2d normalAt(const std::vector<Beam>& beams, size_t k, double step_rad, const Eigen::Vector2d& sensor, double noise_m)
{
	const double radius_m = std::max({0.1, 6 * noise_m, 2.6 * beams[k].range_m * step_rad});
	Eigen::Vector2d sum = Eigen::Vector2d::Zero();
	Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
	int count = 0;
	const auto take = [&](size_t i)
	{
		const Eigen::Vector2d d = beams[i].p - beams[k].p;
		if (d.squaredNorm() > radius_m * radius_m) return false;
		sum += d;
		squares += d * d.transpose();
		++count;
		return true;
	};
	take(k);
	for (size_t i = k; i-- > 0 && k - i <= kMaxBeams;)
		if (!take(i)) break;
	for (size_t i = k + 1; i < beams.size() && i - k <= kMaxBeams; ++i)
		if (!take(i)) break;
	if (count < 3) return Eigen::Vector2d::Zero();
	const Eigen::Matrix2d C = squares / count - sum * sum.transpose() / (count * count);
	const double half = 0.5 * (C(0, 0) + C(1, 1)), d = 0.5 * (C(0, 0) - C(1, 1));
	const double root = std::sqrt(d * d + C(0, 1) * C(0, 1));
	if (half - root > 0.2 * (half + root)) return Eigen::Vector2d::Zero();
	const double along = 0.5 * std::atan2(2 * C(0, 1), C(0, 0) - C(1, 1));
	const Eigen::Vector2d n(-std::sin(along), std::cos(along));
	return n.dot(sensor - beams[k].p) < 0 ? Eigen::Vector2d(-n) : n;
}
}  // namespace

Cloud scanCloud(const Scan& scan, const ScanOptions& options, const Twist2& twist, double noise_m)
{
	const std::vector<Beam> beams = beamsOf(scan, options, twist);
	const Eigen::Vector2d sensor = scan.T_OL.p.head<2>();
	Cloud cloud(beams.size());
	for (size_t k = 0; k < beams.size(); ++k) cloud[k] = {beams[k].p, normalAt(beams, k, scan.step_rad, sensor, noise_m)};
	return cloud;
}
}  // namespace viwo::gt
