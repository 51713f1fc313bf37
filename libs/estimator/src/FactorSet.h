#pragma once

#include "residuals/LocalCost.h"

#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <map>
#include <memory>
#include <set>
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

/** Factors, the blocks they act on, and which of those are to be eliminated: columns of the Jacobian, and its rows one factor at a time.
 *
 *  Blocks come in order of first appearance. One-dimensional eliminated blocks that never meet in a factor (landmarks) have a number
 *  instead of a column; the columns of the other eliminated blocks come first.
 *  Residuals are taken at the blocks' present values, Jacobians at the point that a prior among the factors (or any other frozen factor)
 *  holds for a block, for all factors alike. Robust losses enter with Triggs' correction, as in Ceres.
 */
class FactorSet
{
   public:
	using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

	struct Block
	{
		double* data = nullptr;
		BlockShape shape;
		const double* x0 = nullptr;  //!< null: its present value
		bool eliminated = false;
		bool landmark = false;
		int column = 0;  //!< of the Jacobian; of a landmark its number
	};

	void add(Factor factor);
	void eliminate(double* block);

	/** Assigns columns and freezes the costs where a linearisation point is known. To be called once, before all that follows. */
	void prepare();

	const std::vector<Block>& blocks() const { return blocks_; }
	int columns() const { return columns_; }
	int eliminatedColumns() const { return eliminated_columns_; }
	int landmarks() const { return landmarks_; }

	size_t size() const { return factors_.size(); }
	int rowsOf(size_t factor) const { return factors_[factor].cost->num_residuals(); }
	/** Indices into blocks(). */
	const std::vector<size_t>& blocksOf(size_t factor) const { return factor_blocks_[factor]; }
	/** The number of its landmark, or -1. */
	int landmarkOf(size_t factor) const;

	/** Evaluates one factor, loss applied; residual() and jacobian() are its own until the next call.
	 *  @return false where it is not defined at the present state: then it is counted and carries nothing. */
	bool linearize(size_t factor);
	const Eigen::VectorXd& residual() const { return residual_; }
	/** @param i place of the block in blocksOf() */
	Eigen::Map<const RowMajorMatrix> jacobian(size_t i) const { return {pointers_[i], residual_.size(), widths_[i]}; }
	int skippedFactors() const { return skipped_factors_; }

   private:
	size_t indexOf(double* data, const BlockShape& shape);
	void collectBlocks();
	void freezeFactors();
	void assignColumns();
	void applyLoss(const ceres::LossFunction& loss);

	std::vector<Factor> factors_;
	std::vector<std::vector<size_t>> factor_blocks_;
	std::set<const double*> to_eliminate_;   //!< looked up, never iterated
	std::map<const double*, size_t> index_;  //!< looked up, never iterated
	std::vector<Block> blocks_;
	int columns_ = 0, eliminated_columns_ = 0, landmarks_ = 0;
	int skipped_factors_ = 0;

	Eigen::VectorXd residual_;
	std::vector<double> workspace_;  // kept from factor to factor: there are about a thousand small ones a frame
	std::vector<double*> pointers_;
	std::vector<Eigen::Index> widths_;
};
}  // namespace viwo
