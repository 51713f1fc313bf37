#include "viwo/sim/World.h"

#include <viwo/core/Error.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "RectangleTree.h"

namespace viwo::sim
{
namespace
{
void check(const Surface& s, size_t index, size_t materials)
{
	const auto fail = [&](const std::string& what) { throw Error("world: surface " + std::to_string(index) + " " + what); };
	if (std::abs(s.u_W.norm() - 1) > 1e-9 || std::abs(s.v_W.norm() - 1) > 1e-9)
		fail("has an axis that is not of unit length: normalise it");
	if (std::abs(s.u_W.dot(s.v_W)) > 1e-9) fail("has axes that are not perpendicular: give a rectangle");
	if (!(s.width_m > 0 && s.height_m > 0) || !std::isfinite(s.width_m * s.height_m) || !s.origin_W.allFinite())
		fail("has a side that is not positive or finite: give its size in metres");
	if (s.material >= materials) fail("uses a material that is not there: define it first");
}
}  // namespace

World::World(std::vector<Material> materials, std::vector<Surface> surfaces, double ambient)
    : materials_(std::move(materials)), surfaces_(std::move(surfaces)), ambient_(ambient)
{
	for (size_t i = 0; i < surfaces_.size(); ++i) check(surfaces_[i], i, materials_.size());
	tree_ = std::make_shared<const RectangleTree>(surfaces_);
}

std::optional<Hit> World::castRay(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double max_range_m) const
{
	const auto crossing = tree_->first(origin_W, direction_W, max_range_m);
	if (!crossing) return std::nullopt;
	const Surface& s = surfaces_[crossing->surface];
	const Material& m = materialOf(s);
	const Eigen::Vector3d normal = s.normal_W();
	const double slope = normal.dot(direction_W);
	Hit hit;
	hit.distance_m = crossing->distance_m;
	hit.surface = crossing->surface;
	hit.u_m = crossing->u_m;
	hit.v_m = crossing->v_m;
	hit.normal_W = slope <= 0 ? normal : Eigen::Vector3d(-normal);
	hit.cos_incidence = std::min(1.0, std::abs(slope));
	hit.reflectivity = m.reflectivity;
	hit.glass = m.glass;
	return hit;
}

bool World::isVisible(const Surface& s, const Eigen::Vector3d& point_W) const
{
	// In front there must be some room, ended by the front of something: behind a poster it is too narrow, behind a wall there is no end.
	constexpr double kSkin_m = 1e-6, kRoom_m = 0.1, kFar_m = 200;
	const Eigen::Vector3d normal = s.normal_W();
	const auto hit = castRay(point_W + kSkin_m * normal, normal, kFar_m);
	return hit && hit->distance_m > kRoom_m;
}

std::vector<Eigen::Vector3d> World::samplePoints(size_t n, uint64_t seed) const
{
	std::mt19937_64 generator(seed);
	std::uniform_real_distribution<double> uniform(0, 1);
	std::vector<double> area_until;
	double area = 0;
	for (const auto& s : surfaces_) area_until.push_back(area += s.width_m * s.height_m);

	std::vector<Eigen::Vector3d> points;
	points.reserve(n);
	const size_t max_draws = 1000 + 100 * n;
	for (size_t draw = 0; points.size() < n; ++draw)
	{
		if (surfaces_.empty() || draw == max_draws) throw Error("world: hardly any of its surfaces can be seen: close its rooms");
		const auto found = std::upper_bound(area_until.begin(), area_until.end(), uniform(generator) * area);
		const Surface& s = surfaces_[std::min(static_cast<size_t>(found - area_until.begin()), surfaces_.size() - 1)];
		const double u = uniform(generator), v = uniform(generator);
		const Eigen::Vector3d point = s.point_W(u * s.width_m, v * s.height_m);
		if (isVisible(s, point)) points.push_back(point);
	}
	return points;
}

void appendBox(std::vector<Surface>& surfaces, const Eigen::Vector3d& base_centre_W, const Eigen::Vector3d& size_m, double yaw_rad,
               size_t material, uint32_t variant)
{
	const Eigen::Vector3d x(std::cos(yaw_rad), std::sin(yaw_rad), 0), y(-x.y(), x.x(), 0), z = Eigen::Vector3d::UnitZ();
	const Eigen::Vector3d corner = base_centre_W - 0.5 * size_m.x() * x - 0.5 * size_m.y() * y;
	const auto at = [&](double a, double b, double c)
	{ return Eigen::Vector3d(corner + a * size_m.x() * x + b * size_m.y() * y + c * size_m.z() * z); };
	const auto face = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& u, const Eigen::Vector3d& v, double width, double height) {
		surfaces.push_back({origin, u, v, width, height, material, variant, false});
	};

	face(at(0, 0, 0), x, z, size_m.x(), size_m.z());   // looks along -y
	face(at(1, 0, 0), y, z, size_m.y(), size_m.z());   // +x
	face(at(1, 1, 0), -x, z, size_m.x(), size_m.z());  // +y
	face(at(0, 1, 0), -y, z, size_m.y(), size_m.z());  // -x
	face(at(0, 0, 1), x, y, size_m.x(), size_m.y());   // up
	if (base_centre_W.z() > 0) face(at(0, 1, 0), x, -y, size_m.x(), size_m.y());
}

void appendPanel(std::vector<Surface>& surfaces, const Eigen::Vector3d& centre_W, double width_m, double height_m, double yaw_rad,
                 size_t material, uint32_t variant)
{
	// Seen from the front, to the right is the front direction turned by +90 deg.
	const Eigen::Vector3d u(-std::sin(yaw_rad), std::cos(yaw_rad), 0), v = Eigen::Vector3d::UnitZ();
	surfaces.push_back({centre_W - 0.5 * width_m * u - 0.5 * height_m * v, u, v, width_m, height_m, material, variant, false});
}
}  // namespace viwo::sim
