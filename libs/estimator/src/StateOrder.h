#pragma once

namespace viwo
{
/** The order of the error state of a frame, of the rows of the IMU residual and of its covariance (here and nowhere else).
 *  Parameter blocks: a pose is double[7] = p (3), quaternion x y z w (4), with tangent [dp, dphi]; the motion block is double[9] = v, b_a,
 * b_g.
 */
struct StateOrder
{
	static constexpr int p = 0;    //!< position, and alpha of the preintegration
	static constexpr int phi = 3;  //!< rotation vector, right perturbation, and gamma
	static constexpr int v = 6;    //!< velocity, and beta
	static constexpr int b_a = 9;
	static constexpr int b_g = 12;
	static constexpr int size = 15;
};
}  // namespace viwo
