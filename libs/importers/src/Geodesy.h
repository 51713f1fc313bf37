#pragma once

#include <Eigen/Core>

namespace viwo
{
/** A place on the WGS84 ellipsoid. */
struct GeodeticPoint
{
	double latitude_deg = 0, longitude_deg = 0;
	double altitude_m = 0;  //!< above the ellipsoid
};

/** Earth-centred, earth-fixed, m. */
Eigen::Vector3d earthFixed_m(const GeodeticPoint& point);

/** East, north, up of the tangent plane at the origin, m. */
Eigen::Vector3d eastNorthUp_m(const GeodeticPoint& point, const GeodeticPoint& origin);
}  // namespace viwo
