#pragma once

#include <viwo/experiments/Recipes.h>

/** Logs that several tests use. */
namespace viwo::experiments
{
/** Ninety seconds down a corridor and back, with a turn on the spot. */
SimulatedDrive corridorDrive();
/** Ninety seconds on a circle of 1 m radius. */
SimulatedDrive lobbyDrive();

/** The same, while one wheel, the left (0) or the right (1), turns 30 % too much for two seconds. */
SimulatedDrive slipping(const SimulatedDrive& clean, int wheel);

/** @param layout kitti or euroc. */
LogRecipe importedLog(const std::string& name, const std::string& layout, const std::string& folder,
                      const std::vector<std::string>& options);
}  // namespace viwo::experiments
