#pragma once

#include "ScanSmoother.h"

#include <cstdint>
#include <string>
#include <vector>

namespace viwo::gt
{
/** A trinary map, first row on top. */
struct MapImage
{
	std::vector<uint8_t> cells;
	int columns = 0, rows = 0;
	double min_x_m = 0, min_y_m = 0, resolution_m = 0;
};

/** A PNG for people: the map, a scale bar, the trajectory green where good, orange where degenerate, red where odometry alone.
 *  @throws Error when it cannot be written.
 */
void writeMapPicture(const std::string& path, const MapImage& map, const std::vector<FinalPose>& poses);
}  // namespace viwo::gt
