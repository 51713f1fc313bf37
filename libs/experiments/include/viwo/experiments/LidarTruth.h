#pragma once

#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/Table.h>
#include <viwo/experiments/Accuracy.h>
#include <viwo/experiments/Runner.h>

/** The ground truth that the paper used is made from the scans of a lidar. Here that is viwo-groundtruth's, and the simulator's exact
 * truth tells what it is worth. @file */
namespace viwo::experiments
{
/** A drive against the trajectory from its scans. That is planar: only x-y counts. */
struct LidarDrive
{
	std::string sequence;
	uint64_t seed = 0;
	std::string problem;    //!< why there is no ground truth; empty: there is
	bool open = false;      //!< not measured yet
	std::string folder;     //!< of trajectory and map
	double truth_xy_m = 0;  //!< ATE of the ground truth itself against the exact one
	double truth_yaw_deg = 0;
	std::map<std::string, double> ate_xy_m;  //!< of each mode against the ground truth; infinite without figures, NaN of an open run
};

void planLidarTruth(Runner& runner, const Request& request);

/** In the order of sequences, seeds. @param drives the runs that are held against it. @pre planned, and execute() was called. */
std::vector<LidarDrive> lidarDrives(const Runner& runner, const Request& request, const std::vector<DriveResult>& drives);

/** Medians over the seeds. */
Table table1Lidar(const std::vector<LidarDrive>& drives);
Json table1LidarJson(const std::vector<LidarDrive>& drives);
}  // namespace viwo::experiments
