#pragma once

#include <ceres/cost_function.h>

#include <utility>
#include <vector>

namespace viwo
{
enum class BlockKind
{
	pose,  //!< double[7]: p, quaternion x y z w; 6 tangent coordinates [dp, dphi], R <- R Exp(dphi)
	euclidean
};

struct BlockShape
{
	BlockKind kind = BlockKind::euclidean;
	int ambient = 0;
	int tangent = 0;

	static BlockShape pose() { return {BlockKind::pose, 7, 6}; }
	static BlockShape euclidean(int n) { return {BlockKind::euclidean, n, n}; }
};

/** A residual whose Jacobians are written in tangent coordinates.
 *
 *  Subclasses write the mathematics once, in evaluateLocal(); this class lifts the Jacobians to Ceres' ambient coordinates (J_ambient =
 * J_local * MinusJacobian(x), which PoseManifold's PlusJacobian undoes exactly, so that ceres::GradientChecker holds), and takes them at
 * the frozen linearisation point where a block has one (first-estimate Jacobians: residual at x, Jacobian at x0). The marginaliser calls
 * linearize() directly.
 */
class LocalCost : public ceres::CostFunction
{
   public:
	/** Residuals and, where jacobians[i] is not null, the row-major (num_residuals x tangent_i) Jacobian of block i, both at x.
	 *  @return false when the residual is not defined at x (a point behind the camera).
	 */
	virtual bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const = 0;

	/** Jacobians of block `index` are taken at x0 (ambient, copied) from now on; nullptr thaws it. */
	void freeze(int index, const double* x0);

	/** Where the Jacobian of block `index` is taken (ambient), or nullptr when it follows x. */
	virtual const double* linearizationPoint(int index) const;

	/** Residual at x, local Jacobians (row-major; local_jacobians or any entry may be null) at the frozen points where there are any.
	 *  @return false when the residual is not defined at one of them; a factor of which this is true carries no information.
	 */
	bool linearize(double const* const* x, double* residuals, double** local_jacobians) const;

	/** As linearize(), in ambient coordinates. Where the residual is not defined it is the constant kInvalidResidual with zero Jacobians,
	 *  and the result is true all the same: Ceres gives up a whole solve when a residual block fails at its starting point, while a step
	 * into the undefined region now costs more than any it could save and is rejected.
	 */
	bool Evaluate(double const* const* x, double* residuals, double** jacobians) const final;

	/** In standard deviations, as all residuals: above what any defined residual of a sane problem reaches. */
	static constexpr double kInvalidResidual = 1e4;

	const std::vector<BlockShape>& shapes() const { return shapes_; }

   protected:
	LocalCost(int num_residuals, std::vector<BlockShape> shapes);

   private:
	std::vector<BlockShape> shapes_;
	std::vector<std::vector<double>> frozen_;  //!< empty = not frozen
};
}  // namespace viwo
