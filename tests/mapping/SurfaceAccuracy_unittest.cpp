#include "SimulatedScans.h"
#include "SurfaceFigures.h"

#include <octomap/OcTree.h>
#include <viwo/mapping/OctoMapRun.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace viwo
{
namespace
{
using testing::SimulatedScans;
using testing::SurfaceFigures;
using testing::TempFolder;

constexpr double kResolution_m = 0.05;

SurfaceFigures figuresOf(const std::string& world, const std::string& route, double systematic_mm)
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
	const SurfaceFigures f = testing::surfaceFigures(dynamic_cast<const octomap::OcTree&>(*tree), log.world, log.true_hits);
	testing::print(world + ", systematic error up to " + std::to_string(std::lround(systematic_mm)) + " mm", f);
	return f;
}
}  // namespace

TEST(SurfaceAccuracy, Lobby)
{
	const SurfaceFigures f = figuresOf("lobby", "lobby_arc", 0);
	EXPECT_GE(f.near_surface, 0.97);
	EXPECT_GE(f.found, 0.97);
	EXPECT_LE(f.wrongly_occupied, 0.003);
}

TEST(SurfaceAccuracy, Corridor)
{
	const SurfaceFigures f = figuresOf("corridor", "corridor_out_and_back", 0);
	EXPECT_GE(f.near_surface, 0.97);
	EXPECT_GE(f.found, 0.97);
	EXPECT_LE(f.wrongly_occupied, 0.003);
}

/** 30 mm of systematic error and 12 mm of noise: reported, and not far off. */
TEST(SurfaceAccuracy, FullModelOfTheScanner)
{
	for (const SurfaceFigures& f : {figuresOf("lobby", "lobby_arc", 30), figuresOf("corridor", "corridor_out_and_back", 30)})
	{
		EXPECT_GE(f.near_surface, 0.9);
		EXPECT_GE(f.found, 0.9);
		EXPECT_LE(f.wrongly_occupied, 0.01);
	}
}
}  // namespace viwo
