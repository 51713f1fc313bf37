#include <viwo/experiments/Recipes.h>

#include <viwo/core/Error.h>
#include <viwo/core/SharedFiles.h>

#include <algorithm>

#include "TextFiles.h"

namespace viwo::experiments
{
namespace
{
/** To be raised when the simulator makes other logs of the same inputs. */
constexpr const char* kSimulatorVersion = "1";
}  // namespace

bool cameraIsBlindTo(const std::vector<std::string>& overrides)
{
	return std::all_of(overrides.begin(), overrides.end(),
	                   [](const std::string& word) { return word.rfind("wheels.", 0) == 0 || word.rfind("imu.", 0) == 0; });
}

SimulatedDrive SimulatedDrive::with(const std::string& what, const std::vector<std::string>& more) const
{
	SimulatedDrive drive = *this;
	drive.name += "-" + what;
	const bool same = cameraIsBlindTo(more);
	drive.same_images = !same ? nullptr : same_images ? same_images : std::make_shared<const SimulatedDrive>(*this);
	drive.overrides.insert(drive.overrides.end(), more.begin(), more.end());
	return drive;
}

std::string SimulatedDrive::worldPath() const
{
	return findShare("worlds/" + world + ".ini");
}
std::string SimulatedDrive::routePath() const
{
	return findShare("routes/" + route + ".ini");
}
std::string SimulatedDrive::rigPath() const
{
	return findShare("rigs/" + rig + ".ini");
}

LogRecipe SimulatedDrive::log(uint64_t seed) const
{
	LogRecipe recipe;
	recipe.name = name + "-s" + std::to_string(seed);
	recipe.program = "viwo-sim";
	// The threads of one log are not worth their while beside other logs.
	recipe.arguments = {"--world", worldPath(), "--route", routePath(), "--rig", rigPath(), "--seed", std::to_string(seed), "--jobs", "1"};
	recipe.content = std::string("viwo-sim, version ") + kSimulatorVersion + "\nseed " + std::to_string(seed) + "\n";
	for (const std::string& word : overrides)
	{
		recipe.arguments.insert(recipe.arguments.end(), {"--set", word});
		recipe.content += word + "\n";
	}
	if (same_images) recipe.same_images = std::make_shared<const LogRecipe>(same_images->log(seed));
	for (const std::string& path : {worldPath(), routePath(), rigPath()}) recipe.content += "----\n" + readFile(path);
	return recipe;
}
}  // namespace viwo::experiments
