#pragma once

#include <Eigen/Core>

/** Exact integrals of a vector that is constant in a frame turning at a constant rate: Gamma_n(phi) = sum_k [phi]_x^k / (k + n)!.
 *  Gamma_1 is the left Jacobian of SO(3): displacement over mean velocity; Gamma_2 is displacement over acceleration and dt^2.
 *  Source: Bloesch et al., "State estimation for legged robots: consistent fusion of leg kinematics and IMU", 2012 (there Gamma_n).
 */
namespace viwo::rotating
{
/** Gamma_n(phi), n >= 1; accurate to machine precision for |phi| up to about pi. */
Eigen::Matrix3d gamma(int n, const Eigen::Vector3d& phi);

/** d(Gamma_n(phi) a) / dphi for a fixed vector a. */
Eigen::Matrix3d gammaTimesVectorDerivative(int n, const Eigen::Vector3d& phi, const Eigen::Vector3d& a);
}  // namespace viwo::rotating
