#include "Marginalizer.h"

#include "MarginalInformation.h"
#include "residuals/BlockAlgebra.h"

#include <Eigen/QR>
#include <algorithm>
#include <numeric>

namespace viwo
{
namespace
{
/** The fewest rows with the same A^T A, for A = [J | r]: the triangular factor, without the row that holds only a constant residual. */
Eigen::MatrixXd compressed(const Eigen::MatrixXd& A)
{
	const Eigen::Index unknowns = A.cols() - 1;
	if (A.rows() <= unknowns) return A;
	const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A);
	return qr.matrixQR().topRows(unknowns).triangularView<Eigen::Upper>();
}

/** Writes the factor linearised last into rows of [J | r], whose columns of J are given by `column`. */
void scatter(const FactorSet& factors, size_t factor, const std::vector<int>& column, Eigen::Ref<Eigen::MatrixXd> rows)
{
	const std::vector<size_t>& ids = factors.blocksOf(factor);
	for (size_t i = 0; i < ids.size(); ++i)
	{
		const FactorSet::Block& block = factors.blocks()[ids[i]];
		if (block.landmark) continue;
		rows.middleCols(column[static_cast<size_t>(block.column)], block.shape.tangent) += factors.jacobian(i);
	}
	rows.rightCols<1>() = factors.residual();
}

/** The columns of J that factors on landmarks touch, in order, and that of r. */
std::vector<int> columnsOfLandmarkFactors(const FactorSet& factors)
{
	std::vector<bool> touched(static_cast<size_t>(factors.columns()), false);
	for (size_t f = 0; f < factors.size(); ++f)
	{
		if (factors.landmarkOf(f) < 0) continue;
		for (const size_t id : factors.blocksOf(f))
		{
			const FactorSet::Block& block = factors.blocks()[id];
			if (!block.landmark) std::fill_n(touched.begin() + block.column, block.shape.tangent, true);
		}
	}
	std::vector<int> columns;
	for (int column = 0; column < factors.columns(); ++column)
		if (touched[static_cast<size_t>(column)]) columns.push_back(column);
	columns.push_back(factors.columns());
	return columns;
}

/** What the observations of one landmark say about all else: a reflection turns the landmark's column into a multiple of the first unit
 * vector, and only the first row, which is dropped, knows the landmark then. */
Eigen::MatrixXd rowsWithoutLandmark(FactorSet& factors, const std::vector<size_t>& observations, const std::vector<int>& column,
                                    Eigen::Index width)
{
	Eigen::Index count = 0;
	for (const size_t f : observations) count += factors.rowsOf(f);
	Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, width);
	Eigen::VectorXd landmark = Eigen::VectorXd::Zero(count);
	Eigen::Index next = 0;
	for (const size_t f : observations)
	{
		if (!factors.linearize(f)) continue;
		const Eigen::Index n = factors.rowsOf(f);
		scatter(factors, f, column, rows.middleRows(next, n));
		for (size_t i = 0; i < factors.blocksOf(f).size(); ++i)
			if (factors.blocks()[factors.blocksOf(f)[i]].landmark) landmark.segment(next, n) = factors.jacobian(i);
		next += n;
	}
	if (landmark.isZero(0)) return rows.topRows(next);
	Eigen::VectorXd reflector(count - 1), workspace(width);
	double tau = 0, norm = 0;
	landmark.makeHouseholder(reflector, tau, norm);
	rows.applyHouseholderOnTheLeft(reflector, tau, workspace.data());
	return rows.bottomRows(count - 1);
}

Eigen::MatrixXd eliminateLandmarks(FactorSet& factors)
{
	std::vector<std::vector<size_t>> observations(static_cast<size_t>(factors.landmarks()));
	Eigen::Index count = 0;
	for (size_t f = 0; f < factors.size(); ++f)
	{
		if (factors.landmarkOf(f) < 0) continue;
		observations[static_cast<size_t>(factors.landmarkOf(f))].push_back(f);
		count += factors.rowsOf(f);
	}
	const std::vector<int> columns = columnsOfLandmarkFactors(factors);
	std::vector<int> place(static_cast<size_t>(factors.columns()) + 1, 0);
	for (size_t i = 0; i < columns.size(); ++i) place[static_cast<size_t>(columns[i])] = static_cast<int>(i);

	Eigen::MatrixXd A(count, static_cast<Eigen::Index>(columns.size()));
	Eigen::Index filled = 0;
	for (const auto& of_one : observations)
	{
		const Eigen::MatrixXd rows = rowsWithoutLandmark(factors, of_one, place, A.cols());
		A.middleRows(filled, rows.rows()) = rows;
		filled += rows.rows();
	}
	const Eigen::MatrixXd narrow = compressed(A.topRows(filled));
	Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(narrow.rows(), factors.columns() + 1);
	for (size_t i = 0; i < columns.size(); ++i) wide.col(columns[i]) = narrow.col(static_cast<Eigen::Index>(i));
	return wide;
}

/** [J | r] of all factors, landmarks eliminated. */
Eigen::MatrixXd allRows(FactorSet& factors)
{
	const Eigen::MatrixXd seen = eliminateLandmarks(factors);
	Eigen::Index count = seen.rows();
	for (size_t f = 0; f < factors.size(); ++f)
		if (factors.landmarkOf(f) < 0) count += factors.rowsOf(f);

	std::vector<int> same(static_cast<size_t>(factors.columns()) + 1);
	std::iota(same.begin(), same.end(), 0);
	Eigen::MatrixXd A = Eigen::MatrixXd::Zero(count, factors.columns() + 1);
	A.topRows(seen.rows()) = seen;
	Eigen::Index next = seen.rows();
	for (size_t f = 0; f < factors.size(); ++f)
	{
		if (factors.landmarkOf(f) >= 0) continue;
		if (factors.linearize(f)) scatter(factors, f, same, A.middleRows(next, factors.rowsOf(f)));
		next += factors.rowsOf(f);
	}
	return A;
}

/** Drops the first n columns, and the rows that they determine. */
Eigen::MatrixXd eliminateColumns(Eigen::MatrixXd A, Eigen::Index n)
{
	if (n == 0 || A.rows() == 0) return A.rightCols(A.cols() - n);
	// Columns of unit length, so that the units of the states do not decide what counts as determined.
	Eigen::MatrixXd eliminated = A.leftCols(n);
	for (Eigen::Index c = 0; c < n; ++c)
		if (const double norm = eliminated.col(c).norm(); norm > 0) eliminated.col(c) /= norm;
	Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(eliminated.rows(), n);
	qr.setThreshold(1e-13);
	qr.compute(eliminated);
	A.rightCols(A.cols() - n).applyOnTheLeft(qr.householderQ().adjoint());
	return A.bottomRightCorner(A.rows() - qr.rank(), A.cols() - n);
}

/** The triangular factor of what the factors say about the blocks that remain, and its residual. */
Eigen::MatrixXd squareRoot(FactorSet& factors)
{
	return compressed(eliminateColumns(allRows(factors), factors.eliminatedColumns()));
}
}  // namespace

MarginalizationResult Marginalizer::run()
{
	factors_.prepare();
	const Eigen::MatrixXd A = squareRoot(factors_);
	MarginalizationResult result;
	result.skipped_factors = factors_.skippedFactors();
	Eigen::VectorXd deviation(A.cols() - 1);
	for (const FactorSet::Block& block : factors_.blocks())
	{
		if (block.eliminated) continue;
		const double* x0 = block.x0 ? block.x0 : block.data;
		result.blocks.push_back(block.data);
		result.shapes.push_back(block.shape);
		result.x0.emplace_back(x0, x0 + block.shape.ambient);
		blockMinus(block.shape, block.data, x0, deviation.data() + block.column - factors_.eliminatedColumns());
	}
	if (result.blocks.empty()) return result;
	result.J0 = A.leftCols(A.cols() - 1);
	result.r0 = A.rightCols<1>() - result.J0 * deviation;  // A holds the residual at the present state, r0 is the one at x0
	return result;
}

bool Marginalizer::remainingInformation(std::vector<double*>& blocks, Eigen::MatrixXd& information)
{
	factors_.prepare();
	blocks.clear();
	for (const FactorSet::Block& block : factors_.blocks())
		if (!block.eliminated) blocks.push_back(block.data);
	if (marginalInformation(factors_, information)) return true;
	const Eigen::MatrixXd A = squareRoot(factors_);
	const auto J0 = A.leftCols(A.cols() - 1);
	information = J0.transpose() * J0;
	return information.allFinite();
}
}  // namespace viwo
