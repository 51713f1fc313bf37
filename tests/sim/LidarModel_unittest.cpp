#include <gtest/gtest.h>
#include <viwo/sim/LidarModel.h>

#include <cmath>

#include "SimFixtures.h"

namespace viwo::sim
{
namespace
{
using Eigen::Vector3d;

/** A room of 8 x 6 m about the origin, and a pillar; materials: wall, glass, dark. */
World room(size_t east_material = 0, bool pillar = false)
{
	std::vector<Material> materials(3);
	materials[1].glass = true;
	materials[2].reflectivity = 0.001;
	std::vector<Surface> surfaces;
	appendPanel(surfaces, {4, 0, 1.5}, 6, 3, M_PI, east_material);
	appendPanel(surfaces, {-4, 0, 1.5}, 6, 3, 0, 0);
	appendPanel(surfaces, {0, 3, 1.5}, 8, 3, -M_PI / 2, 0);
	appendPanel(surfaces, {0, -3, 1.5}, 8, 3, M_PI / 2, 0);
	if (pillar) appendBox(surfaces, {2, 0, 0}, {0.3, 0.3, 3}, 0, 0);
	return World(materials, surfaces);
}

Route atOrigin(const std::string& segments)
{
	Route route;
	route.segments = segments;
	return route;
}

/** Exact distance from a point inside of the empty room along a horizontal direction. */
double wallDistance(const Vector3d& p, const Vector3d& d)
{
	double distance = 1e9;
	if (d.x() != 0) distance = std::min(distance, ((d.x() > 0 ? 4 : -4) - p.x()) / d.x());
	if (d.y() != 0) distance = std::min(distance, ((d.y() > 0 ? 3 : -3) - p.y()) / d.y());
	return distance;
}

TEST(LidarModel, PerfectRangesAreTheExactDistancesAtEachBeamsOwnTime)
{
	const Motion motion(atOrigin("free 10 s"), FloorOptions(), VibrationOptions(), 3);
	const World world = room();
	LidarModel lidar(motion, world, LidarOptions::perfect(), 3);
	double worst = 0, worst_without_sweep = 0;
	for (int64_t i = 0; i < lidar.count(); i += 10)
	{
		const LidarScan scan = lidar.scan(i);
		ASSERT_EQ(scan.ranges_m.size(), 541u);
		for (int beam = 0; beam < 541; beam += 3)
		{
			const auto range = [&](double t_s)
			{
				const Pose3 T_WL = motion.at(t_s).T_WO * lidar.T_OL();
				const double a = (-135 + 0.5 * beam) * M_PI / 180;
				return wallDistance(T_WL.p, T_WL.R * Vector3d(std::cos(a), std::sin(a), 0));
			};
			const double found = scan.ranges_m[static_cast<size_t>(beam)];
			worst = std::max(worst, std::abs(found - range(lidar.time_s(i) + 0.03 * beam / 540)));
			worst_without_sweep = std::max(worst_without_sweep, std::abs(found - range(lidar.time_s(i))));
		}
	}
	measured("LMS100 range against the exact ray", 1e6 * worst, "um");
	EXPECT_LT(worst, 5e-6);
	EXPECT_GT(worst_without_sweep, 3e-3) << "the motion during the sweep must be seen";
}

TEST(LidarModel, NoiseAndSystematicErrorHaveTheirSizes)
{
	const Motion motion(atOrigin("stand 40 s"));
	const World world = room();
	LidarOptions options = LidarOptions::perfect();
	LidarModel exact(motion, world, options, 1);
	const LidarScan truth = exact.scan(0);
	options.noise_mm = 12;
	options.systematic_error_mm = 30;
	LidarModel noisy(motion, world, options, 1);
	std::vector<double> mean(541, 0), squared(541, 0);
	const int64_t scans = noisy.count();
	for (int64_t i = 0; i < scans; ++i)
	{
		const LidarScan scan = noisy.scan(i);
		for (size_t b = 0; b < 541; ++b)
		{
			const double e = scan.ranges_m[b] - truth.ranges_m[b];
			mean[b] += e / static_cast<double>(scans);
			squared[b] += e * e / static_cast<double>(scans);
		}
	}
	double variance = 0, worst_mean = 0, jump = 0;
	for (size_t b = 0; b < 541; ++b)
	{
		variance += (squared[b] - mean[b] * mean[b]) / 541;
		worst_mean = std::max(worst_mean, std::abs(mean[b]));
		if (b > 0 && std::abs(truth.ranges_m[b] - truth.ranges_m[b - 1]) < 0.01) jump = std::max(jump, std::abs(mean[b] - mean[b - 1]));
	}
	measured("LMS100 statistical error", 1e3 * std::sqrt(variance), "mm");
	measured("LMS100 largest systematic error", 1e3 * worst_mean, "mm");
	EXPECT_NEAR(std::sqrt(variance), 0.012, 0.0003);
	EXPECT_LT(worst_mean, 0.032);
	EXPECT_GT(worst_mean, 0.01);
	EXPECT_LT(jump, 0.004) << "the systematic error is smooth";
}

TEST(LidarModel, MixedPixelsLieBetweenTheTwoSidesOfAnEdge)
{
	const Motion motion(atOrigin("stand 4 s"));
	const World world = room(0, true);
	LidarOptions options = LidarOptions::perfect();
	LidarModel exact(motion, world, options, 1);
	const LidarScan truth = exact.scan(0);
	options.beam_width_deg = 0.86;
	LidarModel mixing(motion, world, options, 1);
	int mixed = 0;
	for (int64_t i = 0; i < mixing.count(); ++i)
	{
		const LidarScan scan = mixing.scan(i);
		for (size_t b = 1; b + 1 < scan.ranges_m.size(); ++b)
		{
			const float low = std::min({truth.ranges_m[b - 1], truth.ranges_m[b], truth.ranges_m[b + 1]});
			const float high = std::max({truth.ranges_m[b - 1], truth.ranges_m[b], truth.ranges_m[b + 1]});
			EXPECT_GE(scan.ranges_m[b], low - 1e-6F);
			EXPECT_LE(scan.ranges_m[b], high + 1e-6F);
			if (high - low > 0.5F && std::min(scan.ranges_m[b] - low, high - scan.ranges_m[b]) > 0.05F) ++mixed;
		}
	}
	EXPECT_GT(mixed, 50) << "the pillar has two edges in each of 100 scans";
}

TEST(LidarModel, GlassAndDarkSurfacesDropOut)
{
	const Motion motion(atOrigin("stand 4 s"));
	LidarOptions options = LidarOptions::perfect();
	const auto lost = [&](const World& world)
	{
		LidarModel lidar(motion, world, options, 1);
		int count = 0;
		for (int64_t i = 0; i < lidar.count(); ++i) count += lidar.scan(i).ranges_m[270] == 0;  // straight ahead, at the east wall
		return static_cast<double>(count) / static_cast<double>(lidar.count());
	};
	EXPECT_EQ(lost(room(1)), 0);
	EXPECT_EQ(lost(room(2)), 0);
	options.glass_dropout = 0.7;
	EXPECT_NEAR(lost(room(1)), 0.7, 0.15);
	options.dark_range_m = 18;
	EXPECT_EQ(lost(room(2)), 1);
	EXPECT_EQ(lost(room(0)), 0);
}
}  // namespace
}  // namespace viwo::sim
