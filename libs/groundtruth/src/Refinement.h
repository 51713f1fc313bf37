#pragma once

#include "KeyScans.h"

namespace viwo::gt
{
/** Joint refinement of all key scans: each is registered point to line with its neighbours in time and space, all relative poses enter one
 * graph, and again from the new poses (Lu and Milios, "Globally consistent range scan alignment", 1997). Moves the keys.
 *  @param kept edges of odometry, and those made by hand, that stay in the graph.
 *  @return all edges of the last round.
 */
std::vector<GraphEdge> refineKeys(KeyScans& keys, const std::vector<GraphEdge>& kept, GyroTurns& gyro, const GroundTruthOptions& options,
                                  const Scales& scales, int threads, const std::function<bool(double)>& proceed);
}  // namespace viwo::gt
