#pragma once

#include "KeyScans.h"
#include "ScanSmoother.h"

#include <string>

namespace viwo::gt
{
/** Draws all key scans into an occupancy grid and writes, under `dir`: map.gridmap.gz, map.pgm and map.yaml (ROS map_server, trinary: 254
 * free, 0 occupied, 205 unknown), map.png (for people: the trajectory coloured by quality), map.simplemap.
 *  @throws Error when a file cannot be written.
 */
void writeMaps(const std::string& dir, const Session& session, const KeyScans& keys, const std::vector<FinalPose>& poses,
               double resolution_m);
}  // namespace viwo::gt
