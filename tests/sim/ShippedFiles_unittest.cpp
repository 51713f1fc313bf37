#include <gtest/gtest.h>
#include <viwo/sim/Rig.h>
#include <viwo/sim/SyntheticTracks.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "SimFixtures.h"
#include "TempFolder.h"

namespace viwo::sim
{
namespace
{
const std::string kShare = std::string(VIWO_SOURCE_DIR) + "/share/viwo/";

std::set<std::string> filesIn(const std::string& folder)
{
	std::set<std::string> files;
	for (const auto& entry : std::filesystem::directory_iterator(kShare + folder))
		if (entry.path().extension() == ".ini") files.insert(entry.path().string());
	return files;
}

/** The first line of a route names its world. */
std::string worldOf(const std::string& route_ini)
{
	const std::string text = testing::readFile(route_ini), prefix = "# World ";
	return text.compare(0, prefix.size(), prefix) == 0 ? text.substr(prefix.size(), text.find_first_of(",:") - prefix.size())
	                                                   : std::string();
}

TEST(ShippedRoutes, KeepClearOfEverythingInTheirWorlds)
{
	ASSERT_GE(filesIn("routes").size(), 10u);
	for (const std::string& route_ini : filesIn("routes"))
	{
		SCOPED_TRACE(route_ini);
		Rig rig;
		Route route;
		loadRun(kShare + "rigs/turtlebot2.ini", route_ini, {}, rig, route);
		const World world = World::load(kShare + "worlds/" + worldOf(route_ini) + ".ini");
		const Motion motion(route);
		double clearance_m = 10;
		for (double t = 0; t < motion.duration_s(); t += 0.5)
			for (int i = 0; i < 24; ++i)
				for (const double height_m : {0.1, 0.3})
				{
					const Eigen::Vector3d origin_W = motion.at(t).T_WO.p + Eigen::Vector3d(0, 0, height_m);
					const auto hit = world.castRay(origin_W, {std::cos(i * M_PI / 12), std::sin(i * M_PI / 12), 0}, clearance_m);
					if (hit) clearance_m = hit->distance_m;
				}
		measured(std::filesystem::path(route_ini).stem().string() + ": duration " + std::to_string(motion.duration_s()) + " s, clearance",
		         clearance_m, "m");
		EXPECT_GT(clearance_m, 0.4);
		EXPECT_LT(clearance_m, 9) << "the route is not in the room";
	}
}

TEST(ShippedRig, IsTheDefaultRobotButForItsMountingAndPhases)
{
	Rig shipped, defaults;
	Route route;
	loadRun(kShare + "rigs/turtlebot2.ini", kShare + "routes/sample.ini", {}, shipped, route);
	defaults.imu.pose_error = shipped.imu.pose_error;
	defaults.wheels.phase_ms = shipped.wheels.phase_ms;
	const testing::TempFolder folder;
	saveOptions(folder.file("shipped.ini"), shipped.sections());
	saveOptions(folder.file("defaults.ini"), defaults.sections());
	EXPECT_EQ(testing::readFile(folder.file("shipped.ini")), testing::readFile(folder.file("defaults.ini")));
}

TEST(ShippedWorlds, GiveFeatureTracksAlongTheRoutes)
{
	for (const char* name : {"corridor_out_and_back", "lobby_free"})
	{
		Rig rig;
		Route route;
		loadRun(kShare + "rigs/turtlebot2.ini", kShare + "routes/" + name + ".ini", {}, rig, route);
		const World world = World::load(kShare + "worlds/" + worldOf(kShare + "routes/" + name + ".ini") + ".ini");
		const Motion motion(route, rig.floor, rig.vibration, 1);
		TrackOptions options;
		options.rate_hz = 1;
		options.max_features = 10000;
		options.visible = visibleIn(world);
		size_t fewest = 100000;
		for (const FeatureFrame& frame : makeFeatureFrames(motion, rig.nominalCalibration(), world.samplePoints(10000, 1), options, 1))
			fewest = std::min(fewest, frame.features.size());
		measured(std::string(name) + ": fewest of 10000 points in view", static_cast<double>(fewest), "");
		EXPECT_GT(fewest, 60u);
	}
}
}  // namespace
}  // namespace viwo::sim
