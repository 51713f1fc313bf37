#include <viwo/mapping/GroundFilter.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <random>

namespace viwo
{
namespace
{
constexpr int kTries = 200;
constexpr size_t kFewestPoints = 50;     //!< octomap_server's: fewer say nothing
constexpr size_t kCountedPoints = 2000;  //!< tries are compared on these

struct Plane
{
	Eigen::Vector3d n;
	double d = 0;  //!< n x + d = 0

	double distance_m(const Eigen::Vector3d& p) const { return std::abs(n.dot(p) + d); }
};

std::optional<Plane> throughThree(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const GroundFilter& filter)
{
	const Eigen::Vector3d cross = (b - a).cross(c - a);
	if (cross.norm() < 1e-9) return std::nullopt;
	Plane plane{cross.normalized(), 0};
	plane.d = -plane.n.dot(a);
	if (std::abs(plane.n.z()) < std::cos(filter.angle_rad) || std::abs(plane.d) > filter.plane_distance_m) return std::nullopt;
	return plane;
}

std::optional<Plane> groundPlane(const std::vector<Eigen::Vector3d>& points, const GroundFilter& filter)
{
	if (points.size() < kFewestPoints) return std::nullopt;
	std::mt19937_64 random(1);
	std::uniform_int_distribution<size_t> any(0, points.size() - 1);
	const size_t stride = std::max<size_t>(1, points.size() / kCountedPoints);
	std::optional<Plane> best;
	size_t most = 0;
	for (int i = 0; i < kTries; ++i)
	{
		const size_t a = any(random), b = any(random), c = any(random);
		const auto plane = throughThree(points[a], points[b], points[c], filter);
		if (!plane) continue;
		size_t count = 0;
		for (size_t k = 0; k < points.size(); k += stride)
			if (plane->distance_m(points[k]) <= filter.distance_m) ++count;
		if (count <= most) continue;
		most = count;
		best = plane;
	}
	return most * stride >= kFewestPoints ? best : std::nullopt;
}
}  // namespace

std::vector<bool> GroundFilter::onGround(const std::vector<Eigen::Vector3d>& points_O) const
{
	const std::optional<Plane> plane = groundPlane(points_O, *this);
	std::vector<bool> ground;
	ground.reserve(points_O.size());
	for (const Eigen::Vector3d& p : points_O)
		ground.push_back(plane ? plane->distance_m(p) <= distance_m : std::abs(p.z()) <= plane_distance_m);
	return ground;
}
}  // namespace viwo
