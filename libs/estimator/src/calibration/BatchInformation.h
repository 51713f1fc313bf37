#pragma once

#include "calibration/BatchProblem.h"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <functional>
#include <vector>

namespace viwo
{
/** The normal equations of all factors at the present states: what they leave uncertain, and how noisy the measurements really are. */
class BatchInformation
{
   public:
	/** @return false where the equations are singular. */
	bool compute(const std::vector<BatchFactor>& factors);

	struct Deviations
	{
		Eigen::VectorXd sigma;
		double track_factor = 1;  //!< see BatchTrust: as the residuals say, median over the combinations
	};
	/** Standard deviations of combinations of some blocks' tangents, a row of `combine` each. Errors of neighbouring images have much in
	 *  common (the same patch from nearly the same place), which the normal equations do not know: where the residuals of a track, or of a
	 *  stretch of time, pull together more than the trust allows for, the images' share of the variance grows by as much (a sandwich
	 *  estimate with clusters, as Liang and Zeger's).
	 *  @param stretch number of the stretch of time in which each factor lies; only those of images are looked at.
	 */
	Deviations deviations(const std::vector<BatchFactor>& factors, const BatchTrust& trust, const std::vector<const double*>& blocks,
	                      const Eigen::MatrixXd& combine, const std::vector<int>& stretch) const;

	/** Squared residuals of a kind over their redundancy: 1 where the deviations were right (variance components by Foerstner, with the
	 * trace of the hat matrix from random signs, as Hutchinson's). @param counts whether row `row` of a factor of the group is of the kind.
	 *  @param by_median of the squares, which some that are no noise (slip) do not move.
	 */
	double varianceFactor(BatchGroup group, const std::function<bool(int row)>& counts, bool by_median) const;

   private:
	using Sparse = Eigen::SparseMatrix<double>;
	struct Row
	{
		BatchGroup group;
		int row;  //!< within its factor
		int factor;
	};
	struct Columns
	{
		const double* block;
		int first, size;
	};
	/** The variance of a combination, by what it comes from. */
	struct Variance
	{
		double others = 0, images = 0;                       //!< as the trust says
		double single = 0, by_tracks = 0, by_stretches = 0;  //!< as the images' residuals say, each for itself or together
	};
	Variance variance(const std::vector<BatchFactor>& factors, const Eigen::VectorXd& influence, const std::vector<int>& stretch) const;

	std::vector<Row> rows_;
	std::vector<Columns> columns_;
	Sparse J_;
	Eigen::VectorXd residual_;
	Eigen::SimplicialLDLT<Sparse> ldlt_;
};
}  // namespace viwo
