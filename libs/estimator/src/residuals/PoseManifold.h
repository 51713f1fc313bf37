#pragma once

#include <ceres/manifold.h>

namespace viwo
{
/** The manifold of a pose block (7 numbers, 6 tangent coordinates [dp, dphi]): p adds, R <- R Exp(dphi).
 *
 *  With q = (v, w), q (x) (dphi/2, 1) gives the Jacobian of Plus at 0: d(v, w) = 1/2 [w I + [v]_x; -v^T] dphi.
 *  Minus has the inverse there: dphi = 2 [w I - [v]_x, -v] d(v, w); the product of the two is the identity for a unit quaternion.
 *  Ceres' own quaternion manifolds perturb on the left with half the angle, hence this one.
 */
class PoseManifold : public ceres::Manifold
{
   public:
	int AmbientSize() const override { return 7; }
	int TangentSize() const override { return 6; }
	bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
	bool PlusJacobian(const double* x, double* jacobian) const override;
	bool Minus(const double* y, const double* x, double* y_minus_x) const override;
	bool MinusJacobian(const double* x, double* jacobian) const override;
};
}  // namespace viwo
