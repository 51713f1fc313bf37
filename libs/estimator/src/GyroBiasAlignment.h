#pragma once

#include <viwo/core/Calibration.h>
#include <viwo/estimator/InitializerOptions.h>
#include <viwo/sfm/StructureFromMotion.h>

#include <Eigen/Core>
#include <vector>

#include "Belief.h"
#include "ImuPreintegration.h"
#include "WheelPreintegration.h"

namespace viwo
{
struct GyroBiasResult
{
	Eigen::Vector3d b_g = Eigen::Vector3d::Zero();  //!< rad/s
	Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
	double chi2_per_dof = 0;
};

/** Gyroscope bias of the window: the one with which the gyroscope's turns fit vision's (Niu et al. Eq. 9) and, where there are wheels, the
 * wheels' (Eq. 10). All preintegrations are left re-propagated at it, with their accelerometer bias.
 *
 *  The error of a turn is its rotation vector; Eq. 9 and 10 minimise the norm of a unit quaternion, which is always 1. Of Eq. 10 the
 * component about O's z counts: wheels know no other. Covariances: vision's intervals with one another (their errors all but cancel over
 * the window), the gyroscope's noise, which is in both equations, and the wheels' with the error of radii and track that all intervals
 * share.
 *
 *  @param wheels as many as imu, or none.
 */
GyroBiasResult alignGyroBias(const SfmResult& sfm, std::vector<ImuPreintegration>& imu, const std::vector<WheelPreintegration>& wheels,
                             const Calibration& calibration, const Belief& belief, const InitializerOptions& options);
}  // namespace viwo
