#pragma once

#include <viwo/experiments/JobPool.h>
#include <viwo/experiments/Request.h>

#include <string>
#include <vector>

namespace viwo::experiments
{
/** Where an experiment reads and writes. */
struct ExperimentFolders
{
	std::string output;    //!< tables and report; runs under runs/
	std::string cache;     //!< simulated logs; empty: OUTPUT/cache
	std::string programs;  //!< of viwo-sim and viwo-odometry
};

/** What an experiment wrote and found. */
struct ExperimentResult
{
	std::vector<std::string> files;     //!< written
	std::vector<std::string> problems;  //!< runs that failed, a line each
	std::string summary;                //!< the tables as text
	std::string interruption;           //!< how much is not measured and how to go on, one line; empty: all is measured
};

/** Simulates what is missing, runs the modes, and writes table1.*, table1_lidar.*, table2.*, table3.*, ablations.*, error_budget.* (as
 * asked) and report.html. Logs and runs that are whole are kept: an interrupted measurement goes on where it was. When interrupted, it
 * writes what is measured, with marks for the rest.
 *  @throws Error when files cannot be written, or when another measurement uses the same output.
 */
ExperimentResult runExperiments(const Request& request, const ExperimentFolders& folders, size_t jobs, const JobHooks& hooks);
}  // namespace viwo::experiments
