#pragma once

#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/Table.h>
#include <viwo/experiments/Request.h>
#include <viwo/experiments/Runner.h>

/** Tables 2 and 3 of the paper: how long a start in the middle of a drive takes, and how good the next 30 s are. @file */
namespace viwo::experiments
{
/** After the start of one method. Times are from the first image after the start; NaN: never. */
struct StartRun
{
	std::string problem;      //!< of the program
	double first_pose_s = 0;  //!< first metric pose
	double aligned_s = 0;     //!< vision is aligned: status `tracking`
	double rmse_m = 0;        //!< x-y-z in the window of Table 3; NaN: no such window, or did not converge
	double scale = 0;         //!< of the estimate against the truth there
	bool converged = false;
};

/** One start on one sequence. */
struct Start
{
	std::string sequence;
	uint64_t seed = 0;
	double start_s = 0;
	/** The robot drives there: a start in standstill or in a turn on the spot counts for the first metric pose only. */
	bool driving = true;
	bool open = false;  //!< not measured yet
	StartRun ours;      //!< wheels in the initialisation, from the first pose on
	StartRun vins;      //!< VINS-Mono's method: camera and IMU alone; the window afterwards is the same as ours
};

void planStarts(Runner& runner, const Request& request);

/** In the order of sequences, seeds, start times. @pre planned, and execute() was called. */
std::vector<Start> starts(const Runner& runner, const Request& request);

/** Seconds; medians over the seeds. Starts in standstill or on the spot in parentheses and left out of the averages. */
Table table2(const std::vector<Start>& starts);
/** Metres in the 30 s after both methods have started; a dash where a trajectory does not converge. */
Table table3(const std::vector<Start>& starts);
/** Every start. */
Table startRuns(const std::vector<Start>& starts);
Json startsJson(const std::vector<Start>& starts);

/** Averages per sequence over the starts, of medians over the seeds. */
struct StartAverages
{
	std::string sequence;
	double vins_s = 0, aligned_s = 0, first_pose_s = 0;
	double vins_rmse_m = 0, rmse_m = 0;
};
std::vector<StartAverages> startAverages(const std::vector<Start>& starts);
}  // namespace viwo::experiments
