#pragma once

#include <Eigen/Core>
#include <vector>

namespace viwo
{
/** Which points of a cloud lie on the ground. Names and defaults are those of octomap_server. */
struct GroundFilter
{
	double distance_m = 0.04;        //!< points this near to the plane belong to it
	double angle_rad = 0.15;         //!< between the plane's normal and the vehicle's z axis, at most
	double plane_distance_m = 0.07;  //!< between the plane and the vehicle's origin, at most

	/** The plane with most points (RANSAC with a fixed seed); where there is none, points within plane_distance_m of z = 0.
	 *  @param points_O in the vehicle's frame, m.
	 */
	std::vector<bool> onGround(const std::vector<Eigen::Vector3d>& points_O) const;
};
}  // namespace viwo
