#include "ExpectError.h"

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <viwo/mapping/OctreeBuilder.h>

#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <random>
#include <sstream>

namespace viwo
{
namespace
{
using octomap::point3d;

/** Scans of random directions inside of a room, from a sensor that wanders; some repeat, so that voxels reach their limits and prune. */
std::vector<RayScan> wanderingScans(size_t count, uint64_t seed)
{
	std::mt19937_64 random(seed);
	std::uniform_real_distribution<float> any(-1.f, 1.f);
	std::vector<RayScan> scans;
	for (size_t i = 0; i < count; ++i)
	{
		if (i % 5 != 0)
		{
			scans.push_back(scans.back());
			continue;
		}
		RayScan scan;
		const point3d origin(0.5f * any(random), 0.5f * any(random), 0.3f * any(random));
		for (int k = 0; k < 150; ++k)
		{
			const point3d direction(any(random), any(random), any(random));
			const float size = std::max({std::abs(direction.x()) / 3, std::abs(direction.y()) / 2, std::abs(direction.z()) / 1.2f});
			scan.hits.push_back({origin, direction * (1 / size) + point3d(0.05f * any(random), 0, 0)});
		}
		scans.push_back(scan);
	}
	return scans;
}

octomap::Pointcloud cloudOf(const RayScan& scan)
{
	octomap::Pointcloud cloud;
	for (const Ray& ray : scan.hits) cloud.push_back(ray.end);
	return cloud;
}

template <class Tree>
std::string bytesOf(const Tree& tree)
{
	std::ostringstream bytes;
	tree.write(bytes);
	return bytes.str();
}

std::string sequential(const std::vector<RayScan>& scans, double resolution_m, const RayCasting& casting, const SensorModel& model)
{
	octomap::OcTree tree(resolution_m);
	tree.setProbHit(model.hit);
	tree.setProbMiss(model.miss);
	tree.setClampingThresMin(model.clamping_min);
	tree.setClampingThresMax(model.clamping_max);
	for (const RayScan& scan : scans)
		tree.insertPointCloud(cloudOf(scan), scan.hits.front().origin, casting.max_range_m, false, casting.discretize);
	return bytesOf(tree);
}

template <class Tree = octomap::OcTree>
std::string built(const std::vector<RayScan>& scans, double resolution_m, const RayCasting& casting, const SensorModel& model, int threads)
{
	OctreeBuilder<Tree> builder(resolution_m, model, casting, threads);
	for (const RayScan& scan : scans) builder.add(scan);
	builder.finish();
	return bytesOf(builder.tree());
}
}  // namespace

TEST(OctreeBuilder, IsLiboctomapsSequentialInsertionToTheBit)
{
	const std::vector<RayScan> scans = wanderingScans(150, 3);
	SensorModel sure;
	sure.hit = 0.9;
	sure.miss = 0.2;
	sure.clamping_min = 0.05;
	sure.clamping_max = 0.99;
	struct Case
	{
		const char* name;
		double resolution_m;
		RayCasting casting;
		SensorModel model;
	};
	for (const Case& c :
	     {Case{"defaults", 0.08, {}, {}}, Case{"coarse", 0.2, {}, {}}, Case{"range limit", 0.08, {1.7, false}, {}},
	      Case{"discretize", 0.1, {-1, true}, {}}, Case{"discretize and range limit", 0.1, {2, true}, {}}, Case{"model", 0.1, {}, sure}})
	{
		const std::string expected = sequential(scans, c.resolution_m, c.casting, c.model);
		for (const int threads : {1, 3})
			EXPECT_EQ(built(scans, c.resolution_m, c.casting, c.model, threads), expected) << c.name << ", threads " << threads;
	}
}

TEST(OctreeBuilder, WhatPrunesIsEqualToo)
{
	// Few directions, often: whole blocks reach the clamping limit and are pruned; then a ray opens them again.
	std::vector<RayScan> scans = wanderingScans(1, 5);
	for (int i = 0; i < 40; ++i) scans.push_back(scans.front());
	const std::vector<RayScan> others = wanderingScans(30, 6);
	scans.insert(scans.end(), others.begin(), others.end());
	octomap::OcTree tree(0.4);
	for (const RayScan& scan : scans) tree.insertPointCloud(cloudOf(scan), scan.hits.front().origin);
	octomap::OcTree unpruned(tree);
	unpruned.expand();
	std::cout << "[measured] pruned tree " << tree.size() << " nodes, expanded " << unpruned.size() << "\n";
	EXPECT_GT(unpruned.size(), tree.size());
	EXPECT_EQ(built(scans, 0.4, {}, {}, 2), bytesOf(tree));
}

TEST(OctreeBuilder, ClearingRaysAndOriginsOfTheirOwn)
{
	RayScan scan;
	scan.hits = {{{0.5f, 0.5f, 0.5f}, {3.5f, 0.5f, 0.5f}}, {{0.5f, 1.5f, 0.5f}, {3.5f, 1.5f, 0.5f}}};
	scan.clearing = {{{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 3.5f}}};
	OctreeBuilder<octomap::OcTree> builder(1, {}, {}, 1);
	builder.add(scan);
	builder.finish();
	const auto& tree = builder.tree();
	const auto occupied = [&](double x, double y, double z) { return tree.isNodeOccupied(tree.search(x, y, z)); };
	EXPECT_TRUE(occupied(3.5, 0.5, 0.5));
	EXPECT_TRUE(occupied(3.5, 1.5, 0.5));
	EXPECT_FALSE(occupied(0.5, 1.5, 0.5));
	EXPECT_FALSE(occupied(0.5, 0.5, 2.5));
	EXPECT_EQ(tree.search(0.5, 0.5, 3.5), nullptr) << "nothing is known of a clearing ray's end";
}

TEST(OctreeBuilder, RaysThatCannotBeCastAreCounted)
{
	const float nan = std::numeric_limits<float>::quiet_NaN();
	RayScan scan = wanderingScans(1, 1).front();
	const size_t good = scan.hits.size();
	const std::vector<RayScan> clean{scan};
	scan.hits.push_back({{0, 0, 0}, {nan, 0, 0}});
	scan.hits.push_back({{0, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}});
	scan.hits.push_back({{0, 0, 0}, {1e6f, 0, 0}});
	scan.hits.push_back({{nan, 0, 0}, {1, 0, 0}});
	OctreeBuilder<octomap::OcTree> builder(0.05, {}, {}, 2);
	builder.add(scan);
	builder.finish();
	EXPECT_EQ(builder.unusableRays(), 4u);
	EXPECT_EQ(scan.hits.size(), good + 4);
	EXPECT_EQ(bytesOf(builder.tree()), sequential(clean, 0.05, {}, {}));
}

TEST(OctreeBuilder, ColoursAreAveragedAsOctoMapDoes)
{
	RayScan scan;
	scan.hits = {{{0.5f, 0.5f, 0.5f}, {3.5f, 0.5f, 0.5f}}, {{0.5f, 0.5f, 0.5f}, {3.4f, 0.6f, 0.5f}}};
	scan.colours = {{200, 0, 10}, {100, 0, 30}};
	OctreeBuilder<octomap::ColorOcTree> builder(1, {}, {}, 2);
	builder.add(scan);
	builder.finish();
	octomap::ColorOcTree expected(1);
	expected.insertPointCloud(cloudOf(scan), {0.5f, 0.5f, 0.5f});
	expected.integrateNodeColor(3.5f, 0.5f, 0.5f, 200, 0, 10);
	expected.integrateNodeColor(3.4f, 0.6f, 0.5f, 100, 0, 30);
	expected.updateInnerOccupancy();
	EXPECT_EQ(bytesOf(builder.tree()), bytesOf(expected));
	EXPECT_GT(builder.tree().search(3.5, 0.5, 0.5)->getColor().r, 100);

	// What lies beyond the range limit is not seen, nor is its colour.
	OctreeBuilder<octomap::ColorOcTree> near(1, {}, {2, false}, 1);
	near.add(scan);
	near.add({{{{3.1f, 0.5f, 0.5f}, {3.9f, 0.5f, 0.5f}}}, {}, {}});
	near.finish();
	EXPECT_FALSE(near.tree().search(3.5, 0.5, 0.5)->isColorSet());
}

TEST(OctreeBuilder, SenselessModels)
{
	const auto with = [](auto change)
	{
		SensorModel model;
		change(model);
		OctreeBuilder<octomap::OcTree>(0.1, model, {}, 1);
	};
	using testing::expectError;
	expectError([&] { with([](SensorModel& m) { m.hit = 0.3; }); }, {"hit"});
	expectError([&] { with([](SensorModel& m) { m.miss = 0.6; }); }, {"miss"});
	expectError([&] { with([](SensorModel& m) { m.clamping_min = 0.98; }); }, {"clamping"});
	expectError([&] { with([](SensorModel& m) { m.occupancy_threshold = std::numeric_limits<double>::quiet_NaN(); }); }, {"threshold"});
	expectError([&] { OctreeBuilder<octomap::OcTree>(0, {}, {}, 1); }, {"resolution"});
}
}  // namespace viwo
