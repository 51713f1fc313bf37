#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace viwo
{
/** Of `viwo-evaluate relations`. */
struct RelationArguments
{
	std::string relations, trajectory, stamps, json;
	std::vector<double> sensor;  //!< x (m), y (m), yaw (deg) on the robot; empty: O alone
};

CLI::App* declareRelations(CLI::App& cli, RelationArguments& arguments);

/** @return exit status. */
int evaluateRelations(const RelationArguments& arguments);
}  // namespace viwo
