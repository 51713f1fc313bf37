#pragma once

#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <map>
#include <string>
#include <vector>

#include "JobPool.h"
#include "Scenario.h"
#include "SimulationCache.h"

namespace viwo::accuracy
{
/** What a run of viwo-odometry left behind. */
struct Outcome
{
	std::string error;  //!< one line; empty when the program ended with status 0
	std::string folder;
	std::string ground_truth;

	bool failed() const { return !error.empty(); }
	std::string file(const std::string& name) const { return folder + "/" + name; }
	/** @throws Error when it is not there. */
	Json summary() const;
	Trajectory trajectory() const;
	Trajectory truth() const;
	/** SE3-aligned. @throws Error where nothing can be compared. */
	TrajectoryErrors errors() const;
};

/** Collects the runs that the rows need, each once, makes their logs, and executes them. */
class Runner
{
   public:
	/** @param folder for logs, runs and results. @param programs folder of the programs. */
	Runner(std::string folder, std::string programs);

	/** Asks for a run; one that was asked for before is done once. */
	void want(const RunRecipe& recipe);

	/** @throws Error when interrupted. */
	void execute(size_t parallel);

	/** @pre wanted and executed. */
	Outcome outcome(const RunRecipe& recipe) const;

   private:
	/** Index of the job that makes the log; added on the first call. */
	size_t logJob(const LogRecipe& recipe);
	Job runJob(const RunRecipe& recipe, size_t log_job) const;
	std::string folderOf(const RunRecipe& recipe) const { return folder_ + "/runs/" + recipe.name(); }

	std::string folder_, programs_;
	SimulationCache cache_;
	JobPool pool_;
	std::map<std::string, size_t> logs_;  //!< jobs by the path of the log
	std::map<std::string, size_t> runs_;  //!< jobs by the name of the run
};
}  // namespace viwo::accuracy
