#pragma once

#include <ceres/manifold.h>

#include <array>
#include <vector>

namespace viwo
{
/** PoseManifold with some of its six tangent coordinates [dp, dphi] held where they are. */
class PartialPoseManifold : public ceres::Manifold
{
   public:
	/** @param is_free at least one of the six */
	explicit PartialPoseManifold(const std::array<bool, 6>& is_free);

	int AmbientSize() const override { return 7; }
	int TangentSize() const override { return static_cast<int>(coordinates_.size()); }
	bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
	bool PlusJacobian(const double* x, double* jacobian) const override;
	bool Minus(const double* y, const double* x, double* y_minus_x) const override;
	bool MinusJacobian(const double* x, double* jacobian) const override;

   private:
	std::vector<int> coordinates_;  //!< the free ones, rising
};
}  // namespace viwo
