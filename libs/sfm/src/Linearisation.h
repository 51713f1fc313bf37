#pragma once

#include "Scene.h"

namespace viwo::sfm
{
/** Derivative of bearingError(). */
struct Linearised
{
	Eigen::Matrix<double, 2, 6> camera;  //!< columns [dp in r's axes, dphi right perturbation of R_r_ck]
	Eigen::Matrix<double, 2, 4> point;
};
Linearised linearise(const Eigen::Vector4d& X, const Pose3& T_r_ck, const Eigen::Vector3d& bearing);

/** Standard deviation of a triangulated point's inverse distance from the reference frame, the poses taken as known. */
double inverseDistanceSigma(const ScenePoint& point, const std::vector<std::optional<Pose3>>& T_r_ck, double sigma_rad);
}  // namespace viwo::sfm
