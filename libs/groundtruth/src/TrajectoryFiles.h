#pragma once

#include "KeyScans.h"
#include "ScanSmoother.h"

#include <string>

namespace viwo::gt
{
/** trajectory.tum and trajectory_covariance.csv of all scans, frame O. @throws Error when a file cannot be written. */
void writeTrajectory(const std::string& dir, const Session& session, const std::vector<FinalPose>& poses);

/** graph.g2o (VERTEX_SE2, EDGE_SE2; id = index of the scan; turns by the gyroscope have no information on the position) and
 *  graph_stamps.csv (`id,t_ns`). */
void writeGraph(const std::string& dir, const Session& session, const KeyScans& keys, const std::vector<GraphEdge>& edges,
                const GyroTurns& gyro);
}  // namespace viwo::gt
