#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/** The rotation group: Exp and Log between rotation vectors (rad) and rotations, and their Jacobians.
 *  Rotations are perturbed on the right, R Exp(dphi). All are accurate to machine precision from 0 up to pi.
 *  Source: Sola, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics", Eqs. 132-147. @file
 */
namespace viwo::so3
{
/** [v]_x with [v]_x w = v x w. */
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

Eigen::Quaterniond expQuaternion(const Eigen::Vector3d& phi);
Eigen::Matrix3d exp(const Eigen::Vector3d& phi);

/** Rotation vector of norm <= pi; q and -q give the same vector. */
Eigen::Vector3d log(const Eigen::Quaterniond& q);
Eigen::Vector3d log(const Eigen::Matrix3d& R);

/** J_l(phi): Exp(phi + d) = Exp(J_l d) Exp(phi) to first order; also the mean of Exp(s phi) over s in [0,1]. */
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi);
/** J_r(phi) = J_l(-phi): Exp(phi + d) = Exp(phi) Exp(J_r d) to first order. */
Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& phi);
Eigen::Matrix3d leftJacobianInverse(const Eigen::Vector3d& phi);
Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& phi);
}  // namespace viwo::so3
