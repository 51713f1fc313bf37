#include "TestLogs.h"

#include <viwo/core/Error.h>
#include <viwo/experiments/SimulationCache.h>

#include <filesystem>

#include "StandardDrives.h"

namespace viwo::testing
{
namespace
{
constexpr uint64_t kSeed = 1;
}

experiments::SimulatedDrive corridorTestDrive()
{
	return experiments::corridorDrive().with(
	    "test", {"route.segments=straight 1.5 m, rotate 40 deg, rotate -40 deg, straight 0.6 m", "lidar.enabled=true", "lidar.rate_hz=5"});
}

experiments::SimulatedDrive lobbyTestDrive()
{
	return experiments::lobbyDrive().with("test", {"route.duration_s=20"});
}

experiments::SimulatedDrive sidewaysRobotDrive()
{
	return {
	    "sideways-robot",
	    "lobby",
	    "lobby_free",
	    {"lidar.enabled=false", "route.duration_s=10", "camera.label=left_camera", "camera.colour=true", "camera.pose=0 0.1 0.3 0 0 -90",
	     "camera.width_px=320", "camera.height_px=240", "camera.fx_px=169", "camera.fy_px=169", "camera.cx_px=160.2", "camera.cy_px=118.4",
	     "imu.label=xsens", "imu.rate_hz=100", "imu.pose=-0.05 0.1 0.15 30 0 90", "wheels.label=base", "wheels.rate_hz=50"}};
}

experiments::SimulatedDrive backwardsRobotDrive()
{
	return {"backwards-robot",
	        "lobby",
	        "lobby_free",
	        {"lidar.enabled=false", "route.duration_s=10", "camera.rate_hz=5", "camera.pose=-0.1 -0.06 0.3 90 0 -90",
	         "camera.distortion=kannala_brandt", "camera.coefficients=-0.012 0.006 -0.004 0.001", "camera.fx_px=285", "camera.fy_px=285",
	         "imu.rate_hz=50", "vibration.frequency_max_hz=20", "wheels.rate_hz=5"}};
}

std::vector<experiments::LogRecipe> testLogRecipes()
{
	std::vector<experiments::LogRecipe> recipes;
	for (const auto& drive : {corridorTestDrive(), lobbyTestDrive(), sidewaysRobotDrive(), backwardsRobotDrive()})
		recipes.push_back(drive.log(kSeed));
	return recipes;
}

std::string testLogFolder()
{
	return VIWO_BINARY_DIR "/test_logs";
}

TestLog testLog(const experiments::SimulatedDrive& drive)
{
	const experiments::SimulationCache cache(testLogFolder(), VIWO_BINARY_DIR "/bin");
	const experiments::LogRecipe recipe = drive.log(kSeed);
	TestLog log{cache.rawlog(recipe), cache.groundTruth(recipe)};
	if (!std::filesystem::exists(log.rawlog)) throw Error(log.rawlog + ": not there; run " VIWO_BINARY_DIR "/bin/viwo_test_logs first");
	return log;
}
}  // namespace viwo::testing
