#include "TestLogs.h"

#include <viwo/core/Error.h>

#include <filesystem>

#include "SimulationCache.h"

namespace viwo::testing
{
namespace
{
constexpr uint64_t kSeed = 1;
}

accuracy::SimulatedDrive corridorTestDrive()
{
	return accuracy::corridorDrive().with(
	    "test", {"route.segments=straight 1.5 m, rotate 40 deg, rotate -40 deg, straight 0.6 m", "lidar.enabled=true", "lidar.rate_hz=5"});
}

accuracy::SimulatedDrive lobbyTestDrive()
{
	return accuracy::lobbyDrive().with("test", {"route.duration_s=20"});
}

std::vector<accuracy::LogRecipe> testLogRecipes()
{
	return {corridorTestDrive().log(kSeed), lobbyTestDrive().log(kSeed)};
}

std::string testLogFolder()
{
	return VIWO_BINARY_DIR "/test_logs";
}

TestLog testLog(const accuracy::SimulatedDrive& drive)
{
	const accuracy::SimulationCache cache(testLogFolder(), VIWO_BINARY_DIR "/bin");
	const accuracy::LogRecipe recipe = drive.log(kSeed);
	TestLog log{cache.rawlog(recipe), cache.groundTruth(recipe)};
	if (!std::filesystem::exists(log.rawlog)) throw Error(log.rawlog + ": not there; run " VIWO_BINARY_DIR "/bin/viwo_test_logs first");
	return log;
}
}  // namespace viwo::testing
