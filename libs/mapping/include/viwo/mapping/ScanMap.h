#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <viwo/core/Pose3.h>

#include <string>
#include <vector>

namespace viwo
{
/** A planar scan and where the robot was: O in the map. */
struct PosedScan
{
	mrpt::obs::CObservation2DRangeScan::Ptr scan;
	Pose3 T_WO;
};

/** All scans drawn into one grid that is just large enough, cells in multiples of whole metres from the origin. Beams are drawn up to
 *  farthest_m: farther ones open gaps between them. Beams without a return draw nothing.
 */
mrpt::maps::COccupancyGridMap2D gridOf(const std::vector<PosedScan>& scans, double resolution_m, double farthest_m = 30);

/** MRPT's map of key frames: each scan in a sensory frame of its own at its pose. */
mrpt::maps::CSimpleMap simpleMapOf(const std::vector<PosedScan>& scans);
}  // namespace viwo
