#include "Geodesy.h"

#include <viwo/core/Scalars.h>

#include <cmath>

namespace viwo
{
namespace
{
// WGS84: semi-major axis and flattening.
constexpr double kSemiMajor_m = 6378137, kFlattening = 1 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);
}  // namespace

Eigen::Vector3d earthFixed_m(const GeodeticPoint& point)
{
	const double latitude = point.latitude_deg * kDegree, longitude = point.longitude_deg * kDegree;
	const double normal_m = kSemiMajor_m / std::sqrt(1 - kEccentricity2 * std::pow(std::sin(latitude), 2));
	const double axis_m = (normal_m + point.altitude_m) * std::cos(latitude);
	return {axis_m * std::cos(longitude), axis_m * std::sin(longitude),
	        (normal_m * (1 - kEccentricity2) + point.altitude_m) * std::sin(latitude)};
}

Eigen::Vector3d eastNorthUp_m(const GeodeticPoint& point, const GeodeticPoint& origin)
{
	const double s_lat = std::sin(origin.latitude_deg * kDegree), c_lat = std::cos(origin.latitude_deg * kDegree);
	const double s_lon = std::sin(origin.longitude_deg * kDegree), c_lon = std::cos(origin.longitude_deg * kDegree);
	Eigen::Matrix3d R_enu_earth;
	R_enu_earth << -s_lon, c_lon, 0, -s_lat * c_lon, -s_lat * s_lon, c_lat, c_lat * c_lon, c_lat * s_lon, s_lat;
	return R_enu_earth * (earthFixed_m(point) - earthFixed_m(origin));
}
}  // namespace viwo
