#pragma once

#include <CLI/CLI.hpp>

#include <functional>

/** A subcommand of viwo-calibrate: declares itself in the program, and runs once it was chosen. */
namespace viwo::calibrate
{
struct Command
{
	CLI::App* app = nullptr;
	std::function<int()> run;  //!< exit status; owns its arguments
};

Command addImport(CLI::App& cli);
Command addAllan(CLI::App& cli);
Command addEstimate(CLI::App& cli);
}  // namespace viwo::calibrate
