#pragma once

#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <map>
#include <string>
#include <vector>

#include <viwo/experiments/JobPool.h>
#include <viwo/experiments/Recipes.h>
#include <viwo/experiments/SimulationCache.h>

namespace viwo::experiments
{
/** What a run of viwo-odometry left behind. */
struct Outcome
{
	std::string error;  //!< one line; empty when there is a trajectory
	std::string folder;
	std::string ground_truth;
	bool no_pose = false;  //!< the program came to the end of the log, but the estimator did not start; `error` says so
	bool open = false;     //!< interrupted before it was done; `error` says so

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
	/** @param folder for logs (cache/), runs (runs/) and results. @param programs folder of the programs. */
	Runner(std::string folder, std::string programs);

	/** Another folder for the logs than FOLDER/cache. */
	void keepLogsIn(const std::string& folder) { cache_ = SimulationCache(folder, programs_); }

	/** Runs that are whole are not done again while their log, configuration and program are the same.
	 *  @param program tells one build of viwo-odometry from another. @param truth_program the same of viwo-groundtruth; empty: those are
	 * not kept. */
	void keepRuns(const std::string& program, const std::string& truth_program)
	{
		program_ = program;
		truth_program_ = truth_program;
	}

	/** Asks for a run; one that was asked for before is done once. */
	void want(const RunRecipe& recipe);

	/** Asks for the trajectory and the map that viwo-groundtruth makes of a log's scans. */
	void wantTruth(const LogRecipe& log);

	/** Asks for the rig (`rig.ini`) and the figures (`program.out`, JSON) that viwo-calibrate makes of a log; once for each log. */
	void wantCalibration(const CalibrationRecipe& recipe);

	/** @return false when interrupted: outcomes of what has not been done are open. */
	[[nodiscard]] bool execute(size_t parallel, const JobHooks& hooks);

	/** Programs that have not come to their end, and all that were asked for. */
	size_t open() const { return pool_.open(); }
	size_t size() const { return pool_.size(); }

	/** @pre wanted, and execute() was called. */
	Outcome outcome(const RunRecipe& recipe) const;
	/** Of wantTruth(); `ground_truth` is the simulator's. */
	Outcome truthOutcome(const LogRecipe& log) const;
	/** Of wantCalibration(); `ground_truth` is the simulator's. */
	Outcome calibrationOutcome(const LogRecipe& log) const;

   private:
	/** Index of the job that makes the log; added on the first call. */
	size_t logJob(const LogRecipe& recipe);
	Job runJob(const RunRecipe& recipe, size_t log_job) const;
	std::string contentOf(const RunRecipe& recipe) const;
	Outcome outcomeOf(size_t job, const std::string& folder, const LogRecipe& log) const;
	std::string folderOf(const RunRecipe& recipe) const { return folder_ + "/runs/" + recipe.name(); }
	std::string truthFolderOf(const LogRecipe& log) const { return folder_ + "/truth/" + log.name; }
	std::string calibrationFolderOf(const LogRecipe& log) const { return folder_ + "/calibration/" + log.name; }

	std::string folder_, programs_;
	std::string program_, truth_program_;  //!< empty: every run is done
	SimulationCache cache_;
	JobPool pool_;
	std::map<std::string, size_t> logs_;                   //!< jobs by the path of the log
	std::map<std::string, size_t> runs_;                   //!< jobs by the name of the run
	std::map<std::string, size_t> truths_, calibrations_;  //!< jobs by the name of the log
};
}  // namespace viwo::experiments
