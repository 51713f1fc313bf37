#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

/** A subcommand of viwo-calibrate: declares itself in the program, and runs once it was chosen. */
namespace viwo::calibrate
{
struct Command
{
	CLI::App* app = nullptr;
	std::function<int()> run;  //!< exit status; owns its arguments
};

/** What a result leaves in doubt, on stderr; nothing with --quiet. */
void tellNotes(const std::vector<std::string>& notes);

Command addImport(CLI::App& cli);
Command addAllan(CLI::App& cli);
Command addEstimate(CLI::App& cli);
}  // namespace viwo::calibrate
