#include "Lighting.h"

#include <viwo/core/Ranking.h>

#include <algorithm>
#include <cmath>

namespace viwo::sim
{
namespace
{
using Eigen::Vector3d;

constexpr double kNodeSpacing_m = 0.25;
constexpr double kReach_m = 15;  // lamps further away add nothing that could be seen

struct Lamp
{
	Vector3d point_W, normal_W;
	double strength;  // radiance times area
};

int pointsAlong(double length_m)
{
	constexpr double kSpacing_m = 0.6;
	return std::clamp(static_cast<int>(std::ceil(length_m / kSpacing_m)), 1, 4);
}

std::vector<Lamp> lampsOf(const World& world)
{
	std::vector<Lamp> lamps;
	for (const auto& s : world.surfaces())
	{
		const double emission = world.materialOf(s).emission;
		if (emission <= 0) continue;
		// Several points soften the shadows, and the light of large panes.
		const int columns = pointsAlong(s.width_m), rows = pointsAlong(s.height_m);
		for (int i = 0; i < columns * rows; ++i)
		{
			const Vector3d point = s.point_W(s.width_m * (i % columns + 0.5) / columns, s.height_m * (i / columns + 0.5) / rows);
			lamps.push_back({point, s.normal_W(), emission * s.width_m * s.height_m / (columns * rows)});
		}
	}
	return lamps;
}

double direct(const World& world, const std::vector<Lamp>& lamps, const Vector3d& point, const Vector3d& normal)
{
	double sum = 0;
	for (const auto& lamp : lamps)
	{
		const Vector3d way = lamp.point_W - point;
		const double distance = way.norm();
		if (distance > kReach_m || distance < 1e-3) continue;
		const Vector3d direction = way / distance;
		const double cosines = std::max(0.0, normal.dot(direction)) * std::max(0.0, -lamp.normal_W.dot(direction));
		if (cosines < 1e-4 || world.castRay(point, direction, distance - 0.01)) continue;
		sum += lamp.strength * cosines / (distance * distance + 0.05);
	}
	return sum;
}

/** What a point receives from all around. */
struct Surroundings
{
	double openness = 0;  // share of the ambient light that nooks let through
	double bounced = 0;   // lamp light thrown back by what is opposite
};

/** From cosine-weighted directions on a spiral. `direct_at(surface, u, v)`: lamp light that falls there. */
template <class DirectAt>
Surroundings surroundings(const World& world, const Vector3d& point, const Surface& s, const DirectAt& direct_at)
{
	constexpr int kDirections = 24;
	constexpr double kGoldenAngle_rad = 2.399963229728653, kNook_m = 0.4, kDimming = 0.65;
	Surroundings sum;
	for (int i = 0; i < kDirections; ++i)
	{
		const double radius2 = (i + 0.5) / kDirections, radius = std::sqrt(radius2), angle = i * kGoldenAngle_rad;
		const Vector3d direction =
		    radius * std::cos(angle) * s.u_W + radius * std::sin(angle) * s.v_W + std::sqrt(1 - radius2) * s.normal_W();
		const auto hit = world.castRay(point, direction, kReach_m);
		sum.openness += (hit ? 1 - kDimming * std::exp(-hit->distance_m / kNook_m) : 1) / kDirections;
		if (hit) sum.bounced += world.materialOf(world.surfaces()[hit->surface]).albedo * direct_at(*hit) / kDirections;
	}
	return sum;
}

/** Of lamp light on the surfaces that get any; 1 when none does. */
float medianOfPositive(std::vector<float> values)
{
	values.erase(std::remove_if(values.begin(), values.end(), [](float e) { return !(e > 0); }), values.end());
	if (values.empty()) return 1;
	return upperMedian(values);
}

int nodesAlong(double length_m)
{
	return std::max(2, 1 + static_cast<int>(std::lround(length_m / kNodeSpacing_m)));
}
}  // namespace

Lighting::Lighting(const World& world)
{
	const auto lamps = lampsOf(world);
	for (const auto& s : world.surfaces())
	{
		const int columns = lamps.empty() ? 2 : nodesAlong(s.width_m), rows = lamps.empty() ? 2 : nodesAlong(s.height_m);
		grids_.push_back({columns, rows, static_cast<float>((columns - 1) / s.width_m), static_cast<float>((rows - 1) / s.height_m),
		                  static_cast<float>(columns - 1), static_cast<float>(rows - 1), nodes_.size()});
		nodes_.resize(nodes_.size() + static_cast<size_t>(columns * rows), 1.0f);
	}
	if (lamps.empty()) return;

	const auto forAllNodes = [&](const auto& visit)
	{
		for (size_t i = 0; i < grids_.size(); ++i)
			for (int k = 0; k < grids_[i].columns * grids_[i].rows; ++k)
				visit(world.surfaces()[i], nodePoint(world.surfaces()[i], grids_[i], k), grids_[i].offset + static_cast<size_t>(k));
	};
	forAllNodes([&](const Surface& s, const Vector3d& point, size_t node)
	            { nodes_[node] = static_cast<float>(direct(world, lamps, point, s.normal_W())); });
	std::vector<float> openness(nodes_.size()), from_lamps(nodes_.size());
	const auto direct_at = [&](const Hit& hit)
	{ return static_cast<double>(at(hit.surface, static_cast<float>(hit.u_m), static_cast<float>(hit.v_m))); };
	forAllNodes(
	    [&](const Surface& s, const Vector3d& point, size_t node)
	    {
		    const Surroundings around = surroundings(world, point, s, direct_at);
		    openness[node] = static_cast<float>(around.openness);
		    from_lamps[node] = nodes_[node] + static_cast<float>(around.bounced);
	    });
	// Nominal illumination is what the middle one of all places gets.
	const auto ambient = static_cast<float>(world.ambient());
	const float scale = (1 - ambient) / medianOfPositive(from_lamps);
	for (size_t i = 0; i < nodes_.size(); ++i) nodes_[i] = ambient * openness[i] + scale * from_lamps[i];
}

Vector3d Lighting::nodePoint(const Surface& s, const Grid& grid, int node)
{
	// A little inside of the rim and off the plane: on the rim itself a point is in a wall as often as not.
	const auto share = [](int i, int count) { return std::clamp(static_cast<double>(i) / (count - 1), 0.05, 0.95); };
	return s.point_W(share(node % grid.columns, grid.columns) * s.width_m, share(node / grid.columns, grid.rows) * s.height_m) +
	       0.01 * s.normal_W();
}
}  // namespace viwo::sim
