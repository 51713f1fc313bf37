#pragma once

#include <octomap/OcTree.h>
#include <viwo/sim/World.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

/** How well an octree shows the surfaces of a simulated world. */
namespace viwo::testing
{
constexpr double kNear_m = 0.10;
constexpr int kHitsOfSurfaceVoxel = 3;

inline double distanceToSurface_m(const sim::Surface& s, const Eigen::Vector3d& p)
{
	const Eigen::Vector3d d = p - s.origin_W;
	const double u = std::clamp(d.dot(s.u_W), 0.0, s.width_m), v = std::clamp(d.dot(s.v_W), 0.0, s.height_m);
	return (p - s.point_W(u, v)).norm();
}

inline double distanceToWorld_m(const sim::World& world, const Eigen::Vector3d& p)
{
	double least = std::numeric_limits<double>::infinity();
	for (const sim::Surface& s : world.surfaces()) least = std::min(least, distanceToSurface_m(s, p));
	return least;
}

struct SurfaceFigures
{
	double near_surface = 0;      //!< of the occupied voxels: centres within kNear_m of a true surface
	double found = 0;             //!< of the surface voxels truly hit often: an occupied voxel is within one voxel
	double wrongly_occupied = 0;  //!< of the known voxels farther than kNear_m from all surfaces
};

inline bool hasOccupiedNeighbour(const octomap::OcTree& tree, const octomap::OcTreeKey& key)
{
	for (int i = 0; i < 27; ++i)
	{
		const octomap::OcTreeKey at(static_cast<uint16_t>(key[0] + i % 3 - 1), static_cast<uint16_t>(key[1] + i / 3 % 3 - 1),
		                            static_cast<uint16_t>(key[2] + i / 9 - 1));
		const auto* node = tree.search(at);
		if (node && tree.isNodeOccupied(node)) return true;
	}
	return false;
}

/** @param true_hits_W where beams without any error meet surfaces. */
inline SurfaceFigures surfaceFigures(const octomap::OcTree& tree, const sim::World& world, const std::vector<Eigen::Vector3d>& true_hits_W)
{
	size_t occupied = 0, occupied_near = 0, far = 0, far_occupied = 0;
	octomap::OcTree leaves(tree);
	leaves.expand();
	for (auto leaf = leaves.begin_leafs(), end = leaves.end_leafs(); leaf != end; ++leaf)
	{
		const bool is_near = distanceToWorld_m(world, {leaf.getX(), leaf.getY(), leaf.getZ()}) <= kNear_m;
		const bool is_occupied = leaves.isNodeOccupied(*leaf);
		occupied += is_occupied;
		occupied_near += is_occupied && is_near;
		far += !is_near;
		far_occupied += is_occupied && !is_near;
	}
	std::map<std::tuple<int, int, int>, int> hits;
	for (const Eigen::Vector3d& p : true_hits_W)
	{
		const auto key = tree.coordToKey(p.x(), p.y(), p.z());
		++hits[{key[0], key[1], key[2]}];
	}
	size_t surface = 0, found = 0;
	for (const auto& [at, count] : hits)
	{
		if (count < kHitsOfSurfaceVoxel) continue;
		++surface;
		const auto& [x, y, z] = at;
		found += hasOccupiedNeighbour(tree, {static_cast<uint16_t>(x), static_cast<uint16_t>(y), static_cast<uint16_t>(z)});
	}
	const auto share = [](size_t part, size_t whole) { return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0; };
	return {share(occupied_near, occupied), surface > 0 ? share(found, surface) : std::numeric_limits<double>::quiet_NaN(),
	        share(far_occupied, far)};
}

inline void print(const std::string& what, const SurfaceFigures& f)
{
	std::cout << "[measured] " << what << ": occupied within " << kNear_m << " m of a surface " << 100 * f.near_surface << " %, ";
	if (!std::isnan(f.found)) std::cout << "surface voxels found " << 100 * f.found << " %, ";
	std::cout << "wrongly occupied " << 100 * f.wrongly_occupied << " %\n";
}
}  // namespace viwo::testing
