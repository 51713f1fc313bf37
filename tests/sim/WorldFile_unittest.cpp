#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/sim/World.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>

using namespace viwo;
using namespace viwo::sim;
using Eigen::Vector3d;

namespace
{
const char* const kRoom =
    "[material.white]\nalbedo = 0.8\n[room.a]\nx_m = -2 3\ny_m = -1 1.5\nheight_m = 2.5\nwall = white\nfloor = white\nceiling = white\n";

class WorldFile : public testing::Test
{
   protected:
	~WorldFile() override { std::remove(path_.c_str()); }

	World load(const std::string& text)
	{
		std::ofstream(path_) << text;
		return World::load(path_);
	}

	std::string errorOf(const std::string& text)
	{
		try
		{
			load(text);
		}
		catch (const Error& e)
		{
			return e.what();
		}
		return "no error";
	}

	void expectError(const std::string& text, const std::vector<std::string>& words)
	{
		const std::string message = errorOf(text);
		EXPECT_NE(message.find(path_), std::string::npos) << message;
		EXPECT_EQ(message.find('\n'), std::string::npos) << message;
		for (const auto& word : words) EXPECT_NE(message.find(word), std::string::npos) << "no '" << word << "' in: " << message;
	}

	std::string path_ = std::string(VIWO_BINARY_DIR) + "/" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".ini";
};

double rangeFrom(const World& world, const Vector3d& origin, double yaw_deg)
{
	const auto hit = world.castRay(origin, {std::cos(yaw_deg * M_PI / 180), std::sin(yaw_deg * M_PI / 180), 0}, 100);
	return hit ? hit->distance_m : INFINITY;
}
}  // namespace

TEST_F(WorldFile, roomStandsWhereItSays)
{
	const World world = load(kRoom);
	EXPECT_EQ(world.surfaces().size(), 6u);
	const Vector3d origin(0.5, 0.25, 1);
	EXPECT_NEAR(rangeFrom(world, origin, 0), 2.5, 1e-12);
	EXPECT_NEAR(rangeFrom(world, origin, 90), 1.25, 1e-12);
	EXPECT_NEAR(rangeFrom(world, origin, 180), 2.5, 1e-12);
	EXPECT_NEAR(rangeFrom(world, origin, -90), 1.25, 1e-12);
	EXPECT_NEAR(world.castRay(origin, -Vector3d::UnitZ(), 9)->distance_m, 1, 1e-12);
	EXPECT_NEAR(world.castRay(origin, Vector3d::UnitZ(), 9)->distance_m, 1.5, 1e-12);
}

TEST_F(WorldFile, openingsLetRaysThroughOnAllSides)
{
	const World world =
	    load(std::string(kRoom) +
	         "skirting = white\nopenings_x0 = -0.5 0.3 2\nopenings_x1 = -0.5 0.3 2\nopenings_y0 = 0 1 2\nopenings_y1 = 0 1 2\n");
	for (double yaw : {0.0, 90.0, 180.0, -90.0}) EXPECT_TRUE(std::isinf(rangeFrom(world, {0.5, -0.1, 1}, yaw))) << yaw;
	for (double yaw : {0.0, 180.0}) EXPECT_FALSE(std::isinf(rangeFrom(world, {0.5, 0.4, 1}, yaw))) << yaw;
	for (double yaw : {90.0, -90.0}) EXPECT_FALSE(std::isinf(rangeFrom(world, {1.1, 0.1, 1}, yaw))) << yaw;
	for (double yaw : {0.0, 90.0, 180.0, -90.0}) EXPECT_FALSE(std::isinf(rangeFrom(world, {0.5, -0.1, 2.2}, yaw))) << yaw;
	// The skirting stands out by 12 mm.
	EXPECT_NEAR(rangeFrom(world, {0.5, 0.5, 0.04}, 0), 2.488, 1e-9);
}

TEST_F(WorldFile, elementsStandWhereTheySay)
{
	const World world =
	    load(std::string(kRoom) + "[box.b]\nbase_m = 2 0 0\nsize_m = 0.4 0.6 1\nmaterial = white\ncount = 2\nstep_m = -3 0 0\n" +
	         "[panel.p]\ncentre_m = 0.5 1.5 1.2\nsize_m = 0.5 0.5\ndepth_m = 0.03\nyaw_deg = -90\nmaterial = white\nrim = white\n" +
	         "[rect.r]\norigin_m = 1 -0.9 0.5\nu_m = 0.2 0 0\nv_m = 0 0 0.2\nmaterial = white\n" +
	         "[door.d]\nbase_m = 0.5 -1 0\nyaw_deg = 90\nleaf = white\nframe = white\nhandle = white\nsign = white\n");
	EXPECT_NEAR(rangeFrom(world, {0, 0, 0.5}, 0), 1.8, 1e-12);
	EXPECT_NEAR(rangeFrom(world, {0, 0, 0.5}, 180), 0.8, 1e-12);
	EXPECT_NEAR(rangeFrom(world, {0.5, 0, 1.2}, 90), 1.47, 1e-12);
	EXPECT_NEAR(rangeFrom(world, {0.3, 0, 1.5}, -90), 0.98, 1e-12);     // door leaf
	EXPECT_NEAR(rangeFrom(world, {0.02, 0, 1.5}, -90), 0.95, 1e-12);    // its frame
	EXPECT_NEAR(rangeFrom(world, {1.1, 0, 0.6}, -90), 0.9, 1e-12);      // the free rectangle, from its front
	EXPECT_NEAR(rangeFrom(world, {1.1, -0.99, 0.6}, 90), 0.09, 1e-12);  // and from behind
}

TEST_F(WorldFile, mistakesAreNamed)
{
	expectError(std::string(kRoom) + "[bos.b]\nsize_m = 1 1 1\n", {"[bos.b]", "box"});
	expectError(std::string(kRoom) + "[box.b]\nsiez_m = 1 1 1\nmaterial = white\n", {"[box.b]", "siez_m", "size_m"});
	expectError(std::string(kRoom) + "[box.b]\nsize_m = 1 x 1\nmaterial = white\n", {"[box.b]", "size_m"});
	expectError(std::string(kRoom) + "[box.b]\nsize_m = 1 1\nmaterial = white\n", {"[box.b]", "size_m", "3 numbers"});
	expectError(std::string(kRoom) + "[box.b]\nsize_m = 1 1 -1\nmaterial = white\n", {"[box.b]", "size_m"});
	expectError(std::string(kRoom) + "[box.b]\nmaterial = whyte\n", {"[box.b]", "whyte", "white"});
	expectError(std::string(kRoom) + "[material.m]\ntexture = marble\n", {"[material.m]", "texture", "tiles"});
	expectError(std::string(kRoom) + "[material.m]\nalbedo = 1.5\n", {"[material.m]", "albedo"});
	expectError(std::string(kRoom) + "openings_x0 = -5 0 2\n", {"[room.a]", "openings"});
	expectError("[material.white]\nalbedo = 0.8\n", {"empty", "room"});
	EXPECT_THROW(World::load("/nowhere/world.ini"), Error);
}

class ShippedWorld : public testing::TestWithParam<const char*>
{
};

TEST_P(ShippedWorld, isClosedAndFreeWhereRobotsDrive)
{
	const World world = World::load(std::string(VIWO_SOURCE_DIR) + "/share/viwo/worlds/" + GetParam());
	std::mt19937_64 generator(1);
	std::normal_distribution<double> normal;
	std::uniform_real_distribution<double> x(-2, 5), y(-0.6, 0.6);
	for (int i = 0; i < 20000; ++i)
	{
		const double px = x(generator), py = y(generator);
		Vector3d direction;
		for (int k = 0; k < 3; ++k) direction[k] = normal(generator);
		const auto hit = world.castRay({px, py, 0.3}, direction.normalized(), 60);
		ASSERT_TRUE(hit) << px << " " << py << " " << direction.transpose();
		EXPECT_GT(hit->distance_m, 0.15);
	}
	const auto points = world.samplePoints(2000, 1);
	EXPECT_EQ(points.size(), 2000u);
	for (const auto& p : points) EXPECT_GE(p.z(), 0);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedWorld, testing::Values("corridor.ini", "lobby.ini"));
