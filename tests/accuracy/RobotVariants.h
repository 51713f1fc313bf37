#pragma once

#include <viwo/experiments/Recipes.h>

#include <string>
#include <vector>

namespace viwo::experiments
{
/** A robot that differs from the one of the defaults, and what its user writes into the configuration for that. */
struct RobotVariant
{
	std::string name;  //!< "camera at 5 Hz"
	SimulatedDrive drive;
	std::vector<std::string> configuration;  //!< section.key=value of viwo-odometry; empty: the rawlog says it all
	bool four_wheels = false;                //!< the log comes by way of a ROS bag with a joint for each of four wheels

	LogRecipe log(uint64_t seed) const;
};

/** Other rates, mountings, lenses, labels and sizes on one short drive with free motion in the lobby.
 *  @param bags whether there is a program to make the log of four wheels. */
std::vector<RobotVariant> robotVariants(bool bags);
}  // namespace viwo::experiments
