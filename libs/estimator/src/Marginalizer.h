#pragma once

#include "residuals/LinearPrior.h"

#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <map>
#include <memory>
#include <vector>

namespace viwo
{
/** A residual block of the problem, with what it acts on (as many blocks as cost->shapes()). */
struct Factor
{
	std::shared_ptr<LocalCost> cost;
	std::shared_ptr<ceres::LossFunction> loss;  //!< null: squared error
	std::vector<double*> blocks;
};

/** What the eliminated factors say about the blocks that remain: e = r0 + J0 (x [-] x0). Blocks in order of first appearance. */
struct MarginalizationResult
{
	std::vector<double*> blocks;
	std::vector<BlockShape> shapes;
	std::vector<std::vector<double>> x0;  //!< where all factors on the block are to take their Jacobians from now on
	Eigen::MatrixXd J0;                   //!< rank x (sum of tangent sizes)
	Eigen::VectorXd r0;
	int skipped_factors = 0;  //!< not defined at the present state (a point behind a camera); left out

	/** Whether there is anything to add to the problem: at least one row, all numbers finite. */
	bool usable() const { return J0.rows() > 0 && J0.allFinite() && r0.allFinite(); }
	std::shared_ptr<LinearPrior> makeCost() const { return std::make_shared<LinearPrior>(shapes, x0, J0, r0); }
};

/** Eliminates states together with all their factors (Niu et al. Sec. 6.3; Schur complement), and does nothing else.
 *
 *  Factors are linearised at the blocks' present values: residuals there, Jacobians at the point that a prior among the factors (or any
 *  other frozen factor) holds for a block, for all factors alike. Robust losses enter with Triggs' correction, as in Ceres.
 *  One-dimensional eliminated blocks that never meet in a factor (landmarks) go first, one by one; the others together.
 *  Everything is scaled to a unit diagonal before it is decomposed, so that the units of the states do not decide what counts as zero.
 */
class Marginalizer
{
   public:
	struct Options
	{
		/** Eigenvalues of the scaled information below this part of the largest count as zero. Noise is near 1e-15; what an
		 *  odometry knows about its absolute position after a long drive may be as little as 1e-10. */
		double relative_cut = 1e-14;
	};

	Marginalizer() : Marginalizer(Options()) {}
	explicit Marginalizer(const Options& options) : options_(options) {}

	/** Every factor on an eliminated block has to be added; others must not be. */
	void add(Factor factor);
	void eliminate(double* block);

	/** Freezes the added costs where a linearisation point is known. The blocks themselves are only read. */
	MarginalizationResult run();

	/** Only the information matrix of the blocks that remain, in order of first appearance, by Cholesky: cheaper than run().
	 *  @return false where the eliminated states are not determined by the factors.
	 */
	bool remainingInformation(std::vector<double*>& blocks, Eigen::MatrixXd& information);

   private:
	struct Block
	{
		double* data = nullptr;
		BlockShape shape;
		const double* x0 = nullptr;  //!< null: its present value
		bool eliminated = false;
		bool landmark = false;
		int offset = 0;  //!< column in H, or number of the landmark
	};

	size_t indexOf(double* data, const BlockShape& shape);
	void assemble();
	void collectBlocks();
	void freezeFactors();
	void assignColumns();
	void accumulate(const Factor& factor, const std::vector<size_t>& blocks);
	void eliminateLandmarks();
	void eliminateDense();
	void factorize(MarginalizationResult& result) const;

	Options options_;
	std::vector<Factor> factors_;
	std::vector<std::vector<size_t>> factor_blocks_;
	std::map<double*, bool> to_eliminate_;  //!< looked up, never iterated
	std::map<double*, size_t> index_;       //!< looked up, never iterated
	std::vector<Block> blocks_;
	int dense_size_ = 0, size_ = 0;  //!< columns to eliminate, all columns (landmarks are not columns)
	Eigen::MatrixXd H_;
	Eigen::VectorXd g_;
	Eigen::MatrixXd landmark_H_;  //!< column k: coupling of landmark k
	Eigen::VectorXd landmark_h_, landmark_g_;
	int skipped_factors_ = 0;
	std::vector<double> workspace_;
	std::vector<double*> pointers_;
};
}  // namespace viwo
