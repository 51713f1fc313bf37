#pragma once

#include <viwo/experiments/LidarTruth.h>
#include <viwo/experiments/Starts.h>

#include <string>

#include "Provenance.h"

namespace viwo::experiments
{
/** All tables and figures in one page. @param lidar empty: without ground truth from LiDAR. Pictures of trajectories are those of the first
 * seed. */
std::string reportHtml(const Request& request, const Provenance& provenance, const std::vector<DriveResult>& drives,
                       const std::vector<LidarDrive>& lidar, const std::vector<Start>& starts);
}  // namespace viwo::experiments
