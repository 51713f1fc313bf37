#pragma once

#include <octomap/octomap_types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace viwo
{
/** From the sensor, at the time of the beam, to where the beam ended; in the map, m. */
struct Ray
{
	octomap::point3d origin, end;
};

using RayColour = std::array<uint8_t, 3>;  //!< red, green, blue

/** What one observation tells of the space around it. */
struct RayScan
{
	std::vector<Ray> hits;           //!< free up to the end, which is occupied
	std::vector<Ray> clearing;       //!< free up to the end, of which nothing is known
	std::vector<RayColour> colours;  //!< of the ends of the hits; or empty
};
}  // namespace viwo
