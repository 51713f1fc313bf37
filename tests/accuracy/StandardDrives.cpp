#include "StandardDrives.h"

namespace viwo::experiments
{
// Scans are not what is measured: without them logs are made and read faster.
SimulatedDrive corridorDrive()
{
	return {"corridor", "corridor", "corridor_out_and_back", {"lidar.enabled=false"}};
}
SimulatedDrive lobbyDrive()
{
	return {"lobby", "lobby", "lobby_arc", {"lidar.enabled=false"}};
}

SimulatedDrive slipping(const SimulatedDrive& clean, int wheel)
{
	return clean.with("slip", {"wheels.slips=20 2 0.3 " + std::to_string(wheel)});
}

LogRecipe importedLog(const std::string& name, const std::string& layout, const std::string& folder,
                      const std::vector<std::string>& options)
{
	LogRecipe recipe;
	recipe.name = name;
	recipe.program = "viwo-import";
	recipe.arguments = {layout, folder};
	recipe.arguments.insert(recipe.arguments.end(), options.begin(), options.end());
	for (const std::string& word : recipe.arguments) recipe.content += word + "\n";
	recipe.cached = false;
	return recipe;
}
}  // namespace viwo::experiments
