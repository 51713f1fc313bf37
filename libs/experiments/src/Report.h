#pragma once

#include <viwo/experiments/ErrorBudget.h>
#include <viwo/experiments/LidarTruth.h>
#include <viwo/experiments/Starts.h>

#include <string>
#include <vector>

#include "Provenance.h"

namespace viwo::experiments
{
/** All that was measured. */
struct Findings
{
	Request request;
	Provenance provenance;
	std::vector<DriveResult> drives;
	std::vector<LidarDrive> lidar;  //!< empty: without ground truth from LiDAR
	std::vector<Start> starts;
	std::vector<ErrorBudget> budgets;
};

/** All tables and figures in one page. Pictures of trajectories are those of the first seed. */
std::string reportHtml(const Findings& f);
}  // namespace viwo::experiments
