#pragma once

#include "FactorSet.h"
#include "residuals/LinearPrior.h"

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

namespace viwo
{
/** What the eliminated factors say about the blocks that remain: e = r0 + J0 (x [-] x0). Blocks in order of first appearance. */
struct MarginalizationResult
{
	std::vector<double*> blocks;
	std::vector<BlockShape> shapes;
	std::vector<std::vector<double>> x0;  //!< where all factors on the block are to take their Jacobians from now on
	Eigen::MatrixXd J0;                   //!< rows x (sum of tangent sizes); no more rows than columns
	Eigen::VectorXd r0;
	int skipped_factors = 0;  //!< not defined at the present state (a point behind a camera); left out

	/** Whether there is anything to add to the problem: at least one row, all numbers finite. */
	bool usable() const { return J0.rows() > 0 && J0.allFinite() && r0.allFinite(); }
	std::shared_ptr<LinearPrior> makeCost() const { return std::make_shared<LinearPrior>(shapes, x0, J0, r0); }
};

/** Eliminates states together with all their factors (Niu et al. Sec. 6.3), and does nothing else.
 *
 *  J0^T J0 is the Schur complement of the eliminated columns in J^T J, but J^T J is never formed: orthogonal transformations of the rows of
 *  [J | r] make the eliminated columns triangular, and the rows below them are the prior (Demmel et al., "Square root marginalization").
 *  There is no threshold between small and zero to choose, and no rounding that squaring would carry into directions that no sensor
 * observes. Landmarks go first, one by one, each with a single reflection; the other eliminated states together.
 */
class Marginalizer
{
   public:
	/** Every factor on an eliminated block has to be added, and the prior; others must not be. */
	void add(Factor factor) { factors_.add(std::move(factor)); }
	void eliminate(double* block) { factors_.eliminate(block); }

	/** Freezes the added costs where a linearisation point is known. The blocks themselves are only read. To be called once. */
	MarginalizationResult run();

	/** In place of run(): only the information matrix of the blocks that remain, in order of first appearance. By Cholesky, which is
	 * faster, and as run() does it where the normal equations are singular to machine precision.
	 *  @return false where it is not finite.
	 */
	bool remainingInformation(std::vector<double*>& blocks, Eigen::MatrixXd& information);

   private:
	FactorSet factors_;
};
}  // namespace viwo
