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

std::vector<experiments::LogRecipe> testLogRecipes()
{
	return {corridorTestDrive().log(kSeed), lobbyTestDrive().log(kSeed)};
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
