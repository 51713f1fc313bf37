#pragma once

#include "residuals/LocalCost.h"

#include <viwo/core/Pose3.h>

#include <Eigen/Core>

/** Parameter blocks as points on their manifolds: reading, writing, x [+] delta and y [-] x.
 *  A pose block is double[7] = p (m), quaternion x y z w; p adds, R <- R Exp(dphi).
 */
namespace viwo
{
using Vector6d = Eigen::Matrix<double, 6, 1>;

/** The quaternion is taken as it is, not normalised. */
Pose3 poseFromBlock(const double* block);
void poseToBlock(const Pose3& T, double* block);

Pose3 posePlus(const Pose3& T, const Vector6d& delta);
/** delta = [dp, dphi] with y = x [+] delta. */
Vector6d poseMinus(const Pose3& y, const Pose3& x);

/** result = x [+] delta; result may be x. */
void blockPlus(const BlockShape& shape, const double* x, const double* delta, double* result);
/** delta (tangent size) with y = x [+] delta. */
void blockMinus(const BlockShape& shape, const double* y, const double* x, double* delta);
}  // namespace viwo
