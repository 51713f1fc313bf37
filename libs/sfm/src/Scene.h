#pragma once

#include <viwo/core/Pose3.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "Tracks.h"

namespace viwo::sfm
{
/** Point in the reference frame r as X / w with |(X, w)| = 1, so that what is infinitely far away is nothing special. */
struct ScenePoint
{
	Track track;                       //!< without what has been taken out as false
	std::optional<Eigen::Vector4d> X;  //!< nothing while not triangulated
};

/** The reconstruction as it grows. */
struct Scene
{
	std::vector<std::optional<Pose3>> T_r_ck;
	std::vector<ScenePoint> points;
	int reference = 0;    //!< identity pose
	int scale_frame = 0;  //!< |p| = 1
};

/** f: direction in which camera ck sees a point, not normalised. */
inline Eigen::Vector3d directionOf(const Eigen::Vector4d& X, const Pose3& T_r_ck)
{
	return T_r_ck.R.conjugate() * (X.head<3>() - T_r_ck.p * X.w());
}

/** Error of a seen direction on the tangent plane of the measured bearing, rad; nothing behind the camera. */
std::optional<Eigen::Vector2d> bearingError(const Eigen::Vector4d& X, const Pose3& T_r_ck, const Eigen::Vector3d& bearing);

/** Two columns that complete a unit vector to an orthonormal basis. */
Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& bearing);

/** Least squares on all frames with a pose; nothing with fewer than two of them, or when it comes to lie behind one. */
std::optional<Eigen::Vector4d> triangulate(const Track& track, const std::vector<std::optional<Pose3>>& T_r_ck);
}  // namespace viwo::sfm
