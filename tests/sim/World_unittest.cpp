#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/sim/World.h>

#include <cmath>
#include <iostream>
#include <random>

using namespace viwo::sim;
using Eigen::Vector3d;

namespace
{
/** A closed room, fronts inwards, with boxes that do not touch each other. */
World roomWithBoxes()
{
	Material wall, dark, pane;
	wall.reflectivity = 0.8;
	dark.reflectivity = 0.05;
	pane.glass = true;
	std::vector<Surface> s;
	const double x = 6, y = 4, z = 3;
	s.push_back({{0, 0, 0}, Vector3d::UnitX(), Vector3d::UnitY(), x, y, 0, 0, false});   // floor
	s.push_back({{0, y, z}, Vector3d::UnitX(), -Vector3d::UnitY(), x, y, 0, 0, false});  // ceiling
	appendPanel(s, {0, y / 2, z / 2}, y, z, 0, 0);
	appendPanel(s, {x, y / 2, z / 2}, y, z, M_PI, 2);
	appendPanel(s, {x / 2, 0, z / 2}, x, z, M_PI / 2, 0);
	appendPanel(s, {x / 2, y, z / 2}, x, z, -M_PI / 2, 0);
	for (int i = 0; i < 12; ++i) appendBox(s, {0.6 + 0.45 * i, 1 + 0.2 * (i % 10), 0.1 * i}, {0.3, 0.2, 0.7}, 0.4 * i, 1);
	return World({wall, dark, pane}, s);
}

/** First meeting by trying every rectangle with Cramer's rule. */
double nearestByExhaustion(const World& world, const Vector3d& origin, const Vector3d& direction)
{
	double best = INFINITY;
	for (const auto& s : world.surfaces())
	{
		if (s.normal_W().dot(direction) >= 0) continue;
		Eigen::Matrix3d A;
		A << direction, -s.u_W, -s.v_W;
		const Vector3d t_u_v = A.inverse() * (s.origin_W - origin);
		if (t_u_v[0] > 0 && t_u_v[1] >= 0 && t_u_v[1] <= s.width_m && t_u_v[2] >= 0 && t_u_v[2] <= s.height_m)
			best = std::min(best, t_u_v[0]);
	}
	return best;
}
}  // namespace

TEST(World, castRayAgreesWithAnExhaustiveSearch)
{
	const World world = roomWithBoxes();
	std::mt19937_64 generator(1);
	std::normal_distribution<double> normal;
	double worst = 0;
	for (int i = 0; i < 20000; ++i)
	{
		const Vector3d origin = Vector3d(3, 0.4, 1.5) + 0.05 * Vector3d(normal(generator), normal(generator), normal(generator));
		const Vector3d direction = Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
		const auto hit = world.castRay(origin, direction, 100);
		ASSERT_TRUE(hit);
		worst = std::max(worst, std::abs(hit->distance_m - nearestByExhaustion(world, origin, direction)));
		const Surface& s = world.surfaces()[hit->surface];
		worst = std::max(worst, (s.point_W(hit->u_m, hit->v_m) - (origin + hit->distance_m * direction)).norm());
		EXPECT_LT(hit->normal_W.dot(direction), 0);
	}
	std::cout << "[measured] worst ray distance error " << worst << " m\n";
	EXPECT_LT(worst, 1e-8);
}

TEST(World, castRayKnownDistances)
{
	const World world = roomWithBoxes();
	const auto ahead = world.castRay({3, 0.4, 2.9}, Vector3d::UnitX(), 10);
	ASSERT_TRUE(ahead);
	EXPECT_DOUBLE_EQ(ahead->distance_m, 3);
	EXPECT_DOUBLE_EQ(ahead->cos_incidence, 1);
	EXPECT_TRUE(ahead->glass);
	EXPECT_TRUE(ahead->normal_W.isApprox(-Vector3d::UnitX(), 1e-12));
	EXPECT_FALSE(world.castRay({3, 0.4, 2.9}, Vector3d::UnitX(), 2.99));
	const auto down = world.castRay({0.1, 0.4, 0.3}, Vector3d(1, 0, -1).normalized(), 10);
	ASSERT_TRUE(down);
	EXPECT_NEAR(down->distance_m, 0.3 * std::sqrt(2.0), 1e-15);
	EXPECT_NEAR(down->cos_incidence, std::sqrt(0.5), 1e-15);
	EXPECT_DOUBLE_EQ(down->reflectivity, 0.8);
	EXPECT_FALSE(down->glass);
	EXPECT_NEAR(down->u_m, 0.4, 1e-12);
	EXPECT_NEAR(down->v_m, 0.4, 1e-12);
}

TEST(World, raysPassRectanglesFromBehindUnlessTwoSided)
{
	std::vector<Surface> s;
	appendPanel(s, {1, 0, 0}, 2, 2, M_PI, 0);
	EXPECT_TRUE(World({Material{}}, s).castRay({0, 0, 0}, Vector3d::UnitX(), 5));
	EXPECT_FALSE(World({Material{}}, s).castRay({2, 0, 0}, -Vector3d::UnitX(), 5));
	s[0].two_sided = true;
	const auto hit = World({Material{}}, s).castRay({2, 0, 0}, -Vector3d::UnitX(), 5);
	ASSERT_TRUE(hit);
	EXPECT_TRUE(hit->normal_W.isApprox(Vector3d::UnitX(), 1e-12));
}

TEST(World, noRayLeaksThroughTheSeamsOfAClosedRoom)
{
	const World world = roomWithBoxes();
	std::mt19937_64 generator(2);
	std::uniform_real_distribution<double> along(0, 1);
	for (int i = 0; i < 3000; ++i)
	{
		const double t = along(generator);
		const Vector3d onSeam = i % 3 == 0 ? Vector3d(6 * t, 0, 0) : i % 3 == 1 ? Vector3d(0, 0, 3 * t) : Vector3d(6, 4 * t, 3);
		EXPECT_TRUE(world.castRay({0.2, 3.5, 2.5}, (onSeam - Vector3d(0.2, 3.5, 2.5)).normalized(), 50));
	}
}

TEST(World, samplePointsLieOnVisibleSurfacesAndRepeat)
{
	const World world = roomWithBoxes();
	const auto points = world.samplePoints(500, 7);
	ASSERT_EQ(points.size(), 500u);
	for (const auto& p : points)
	{
		double nearest = 1;
		for (const auto& s : world.surfaces()) nearest = std::min(nearest, std::abs(s.normal_W().dot(p - s.origin_W)));
		EXPECT_LT(nearest, 1e-9);
		EXPECT_GE(p.z(), -1e-9);
		EXPECT_LE(p.z(), 3 + 1e-9);
	}
	const auto again = world.samplePoints(500, 7);
	EXPECT_TRUE(std::equal(points.begin(), points.end(), again.begin()));
	EXPECT_FALSE(std::equal(points.begin(), points.end(), world.samplePoints(500, 8).begin()));
	EXPECT_THROW(World({Material{}}, {Surface{}}).samplePoints(10, 1), viwo::Error);
}

TEST(World, rejectsWhatIsNoRectangle)
{
	Surface skewed;
	skewed.v_W = Vector3d(0.6, 0.8, 0);
	EXPECT_THROW(World({Material{}}, {skewed}), viwo::Error);
	Surface flat;
	flat.width_m = 0;
	EXPECT_THROW(World({Material{}}, {flat}), viwo::Error);
	Surface bare;
	bare.material = 3;
	EXPECT_THROW(World({Material{}}, {bare}), viwo::Error);
}
