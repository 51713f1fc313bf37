#pragma once

#include <viwo/core/Pose3.h>

#include <optional>
#include <vector>

#include "Tracks.h"

namespace viwo::sfm
{
/** Relative pose T_ab of two frames with |p_ab| = 1, from the five-point method and, where there is a prior rotation, from that and the
 * translation that fits it best; each refined on the epipolar distances, the better one taken. Nothing when fewer than 60 % of the pairs
 * agree or lie before both cameras.
 */
std::optional<Pose3> relativePose(const std::vector<Correspondence>& pairs, const std::optional<Eigen::Quaterniond>& R_ab_prior,
                                  double sigma_rad, double outlier_sigmas);
}  // namespace viwo::sfm
