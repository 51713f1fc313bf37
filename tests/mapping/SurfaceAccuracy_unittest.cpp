#include "SimulatedScans.h"

#include <octomap/OcTree.h>
#include <viwo/mapping/OctoMapRun.h>

#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <tuple>

namespace viwo
{
namespace
{
using testing::SimulatedScans;
using testing::TempFolder;

constexpr double kResolution_m = 0.05, kNear_m = 0.10;
constexpr int kHitsOfSurfaceVoxel = 3;

double distanceToSurface_m(const sim::Surface& s, const Eigen::Vector3d& p)
{
	const Eigen::Vector3d d = p - s.origin_W;
	const double u = std::clamp(d.dot(s.u_W), 0.0, s.width_m), v = std::clamp(d.dot(s.v_W), 0.0, s.height_m);
	return (p - s.point_W(u, v)).norm();
}

double distanceToWorld_m(const sim::World& world, const Eigen::Vector3d& p)
{
	double least = std::numeric_limits<double>::infinity();
	for (const sim::Surface& s : world.surfaces()) least = std::min(least, distanceToSurface_m(s, p));
	return least;
}

struct Figures
{
	double near_surface = 0;      //!< of the occupied voxels: centres within kNear_m of a true surface
	double found = 0;             //!< of the surface voxels truly hit often: an occupied voxel is within one voxel
	double wrongly_occupied = 0;  //!< of the known voxels farther than kNear_m from all surfaces
};

bool hasOccupiedNeighbour(const octomap::OcTree& tree, const octomap::OcTreeKey& key)
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

Figures compare(const octomap::OcTree& tree, const SimulatedScans& log)
{
	size_t occupied = 0, occupied_near = 0, far = 0, far_occupied = 0;
	octomap::OcTree leaves(tree);
	leaves.expand();
	for (auto leaf = leaves.begin_leafs(), end = leaves.end_leafs(); leaf != end; ++leaf)
	{
		const bool is_near = distanceToWorld_m(log.world, {leaf.getX(), leaf.getY(), leaf.getZ()}) <= kNear_m;
		const bool is_occupied = leaves.isNodeOccupied(*leaf);
		occupied += is_occupied;
		occupied_near += is_occupied && is_near;
		far += !is_near;
		far_occupied += is_occupied && !is_near;
	}
	std::map<std::tuple<int, int, int>, int> hits;
	for (const Eigen::Vector3d& p : log.true_hits)
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
	return {share(occupied_near, occupied), share(found, surface), share(far_occupied, far)};
}

Figures figuresOf(const std::string& world, const std::string& route, double systematic_mm)
{
	const TempFolder folder;
	const SimulatedScans log(folder, world, route, systematic_mm);
	OctoMapRunOptions options;
	options.rawlog = log.rawlog;
	options.trajectory = log.ground_truth;
	options.output = folder.file("map.ot");
	options.resolution_m = kResolution_m;
	options.rays.scan_duration_s = 0.030;
	options.threads = 2;
	runOctoMap(options);
	const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(options.output));
	const Figures f = compare(dynamic_cast<const octomap::OcTree&>(*tree), log);
	std::cout << "[measured] " << world << ", systematic error up to " << systematic_mm << " mm: occupied within " << kNear_m
	          << " m of a surface " << 100 * f.near_surface << " %, surface voxels found " << 100 * f.found << " %, wrongly occupied "
	          << 100 * f.wrongly_occupied << " %\n";
	return f;
}
}  // namespace

TEST(SurfaceAccuracy, Lobby)
{
	const Figures f = figuresOf("lobby", "lobby_arc", 0);
	EXPECT_GE(f.near_surface, 0.97);
	EXPECT_GE(f.found, 0.97);
	EXPECT_LE(f.wrongly_occupied, 0.003);
}

TEST(SurfaceAccuracy, Corridor)
{
	const Figures f = figuresOf("corridor", "corridor_out_and_back", 0);
	EXPECT_GE(f.near_surface, 0.97);
	EXPECT_GE(f.found, 0.97);
	EXPECT_LE(f.wrongly_occupied, 0.003);
}

/** 30 mm of systematic error and 12 mm of noise: reported, and not far off. */
TEST(SurfaceAccuracy, FullModelOfTheScanner)
{
	for (const Figures& f : {figuresOf("lobby", "lobby_arc", 30), figuresOf("corridor", "corridor_out_and_back", 30)})
	{
		EXPECT_GE(f.near_surface, 0.9);
		EXPECT_GE(f.found, 0.9);
		EXPECT_LE(f.wrongly_occupied, 0.01);
	}
}
}  // namespace viwo
