#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstdint>
#include <string>
#include <vector>

namespace viwo
{
/** A grid of cells that are free, occupied or unknown, as ROS's map_server keeps it (mode trinary). */
struct OccupancyImage
{
	static constexpr uint8_t kFree = 254, kOccupied = 0, kUnknown = 205;

	std::vector<uint8_t> cells;  //!< row by row, first row on top (largest y)
	int columns = 0, rows = 0;
	double min_x_m = 0, min_y_m = 0;  //!< lower left corner of the lower left cell
	double resolution_m = 0;

	/** @param y_from_below row counted from the smallest y. */
	uint8_t& cell(int x, int y_from_below)
	{
		return cells[static_cast<size_t>(rows - 1 - y_from_below) * static_cast<size_t>(columns) + static_cast<size_t>(x)];
	}
	uint8_t cell(int x, int y_from_below) const { return const_cast<OccupancyImage*>(this)->cell(x, y_from_below); }
};

/** MRPT's probabilities, cut where map_server cuts: above 0.65 and below 0.35. */
OccupancyImage occupancyImage(const mrpt::maps::COccupancyGridMap2D& grid);

/** Cells of factor x factor of the map's: occupied where any of those is, free where any is free and none occupied. */
OccupancyImage coarser(const OccupancyImage& map, int factor);

/** `X.yaml` and `X.pgm` beside it: what ROS's map_server, nav2 and MRPT's ros-map-yaml2mrpt read. The image first, so that a YAML file
 *  always has one.
 *  @throws Error when a file cannot be written.
 */
void saveMapServer(const std::string& yaml_path, const OccupancyImage& image);

/** Reads such a pair, made trinary by the YAML's thresholds and `negate`. The image must be a binary PGM; the map must not be turned.
 *  @throws Error naming file and key.
 */
OccupancyImage loadMapServer(const std::string& yaml_path);
}  // namespace viwo
