#pragma once

#include <viwo/experiments/JobPool.h>
#include <viwo/experiments/Request.h>

#include <string>
#include <vector>

namespace viwo::experiments
{
struct ExperimentFolders
{
	std::string output;    //!< tables and report; runs under runs/
	std::string cache;     //!< simulated logs; empty: <output>/cache
	std::string programs;  //!< of viwo-sim and viwo-odometry
};

struct ExperimentResult
{
	std::vector<std::string> files;     //!< written
	std::vector<std::string> problems;  //!< runs that failed, a line each
	std::string summary;                //!< the tables as text
};

/** Simulates what is missing, runs the modes, and writes table1.*, table2.*, table3.*, ablations.*, runs.* (as asked) and report.html.
 *  Logs and runs that are whole are kept: an interrupted measurement goes on where it was.
 *  @throws Error when interrupted, or when files cannot be written.
 */
ExperimentResult runExperiments(const Request& request, const ExperimentFolders& folders, size_t jobs, const JobHooks& hooks);
}  // namespace viwo::experiments
