#pragma once

#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/Table.h>
#include <viwo/experiments/Request.h>
#include <viwo/experiments/Runner.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/** Table 1 of the paper and its ablations: the error of whole drives. @file */
namespace viwo::experiments
{
/** What is run on each sequence: a mode, or one switch turned. */
struct Variant
{
	std::string name;  //!< e.g. "viwo", "without the wheel factor"
	std::string mode;
	std::vector<std::string> overrides;
};

/** vio, wheel, viwo: the columns of Table 1. */
const std::vector<Variant>& modes();

/** What the paper argues for and does not print, each switched off. */
const std::vector<Variant>& ablations();

/** One run against the exact truth. */
struct DriveErrors
{
	uint64_t seed = 0;
	std::string problem;  //!< why there are no figures; empty: there are
	bool failed = false;  //!< the program itself, not the estimator
	bool open = false;    //!< not measured yet
	TrajectoryErrors se3, yaw;
	std::string folder;                          //!< of the run
	std::string ground_truth;                    //!< path
	std::shared_ptr<const Trajectory> estimate;  //!< null where there is none
};

/** All seeds of one variant on one sequence. */
struct DriveResult
{
	std::string sequence;
	Variant variant;
	std::vector<DriveErrors> seeds;

	/** Of figure(errors) over the seeds; a run without counts as infinite. NaN while a run is open. */
	double median(const std::function<double(const DriveErrors&)>& figure) const;
};

/** @param truth read when it is first needed: all runs of a drive have the same. */
DriveErrors driveErrors(const Outcome& outcome, uint64_t seed, std::optional<Trajectory>& truth);

void planDrives(Runner& runner, const Request& request);

/** In the order of sequences, then variants. @pre planned, and execute() was called. */
std::vector<DriveResult> driveResults(const Runner& runner, const Request& request);

/** Medians over the seeds, the paper's figures beside them; the best of our three in bold. Last column: z of viwo after alignment in yaw
 * alone. */
Table table1(const std::vector<DriveResult>& results);
/** Every run: x-y, z, x-y-z, z after alignment in yaw alone. */
Table table1Runs(const std::vector<DriveResult>& results);
/** x-y-z of each ablation beside viwo's. */
Table ablationTable(const std::vector<DriveResult>& results);
Json table1Json(const std::vector<DriveResult>& results);
}  // namespace viwo::experiments
