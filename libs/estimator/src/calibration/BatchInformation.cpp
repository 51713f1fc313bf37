#include "calibration/BatchInformation.h"

#include <viwo/core/Ranking.h>
#include <viwo/core/Scalars.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace viwo
{
bool BatchInformation::compute(const std::vector<BatchFactor>& factors)
{
	FactorSet set;
	for (const BatchFactor& f : factors) set.add(f.factor);
	set.prepare();
	columns_.clear();
	for (const FactorSet::Block& block : set.blocks()) columns_.push_back({block.data, block.column, block.shape.tangent});
	rows_.clear();
	std::vector<Eigen::Triplet<double>> entries;
	std::vector<double> residual;
	for (size_t f = 0; f < set.size(); ++f)
	{
		if (!set.linearize(f)) continue;
		const int begin = static_cast<int>(rows_.size());
		for (int row = 0; row < set.rowsOf(f); ++row)
		{
			rows_.push_back({factors[f].group, row, static_cast<int>(f)});
			residual.push_back(set.residual()[row]);
		}
		for (size_t i = 0; i < set.blocksOf(f).size(); ++i)
		{
			const auto J = set.jacobian(i);
			const int first = set.blocks()[set.blocksOf(f)[i]].column;
			for (int row = 0; row < J.rows(); ++row)
				for (int column = 0; column < J.cols(); ++column)
					if (J(row, column) != 0) entries.emplace_back(begin + row, first + column, J(row, column));
		}
	}
	J_.resize(static_cast<Eigen::Index>(rows_.size()), set.columns());
	J_.setFromTriplets(entries.begin(), entries.end());
	residual_ = Eigen::Map<const Eigen::VectorXd>(residual.data(), static_cast<Eigen::Index>(residual.size()));
	const Sparse H = Sparse(J_.transpose()) * J_;
	ldlt_.compute(H);
	return ldlt_.info() == Eigen::Success && ldlt_.vectorD().minCoeff() > 0;
}

BatchInformation::Deviations BatchInformation::deviations(const std::vector<BatchFactor>& factors, const BatchTrust& trust,
                                                          const std::vector<const double*>& blocks, const Eigen::MatrixXd& combine,
                                                          const std::vector<int>& stretch) const
{
	std::vector<Eigen::Index> columns;
	for (const double* block : blocks)
	{
		const auto at = std::find_if(columns_.begin(), columns_.end(), [&](const Columns& c) { return c.block == block; });
		for (int i = 0; at != columns_.end() && i < at->size; ++i) columns.push_back(at->first + i);
	}
	Deviations result;
	result.sigma.resize(combine.rows());
	std::vector<double> track_factors;
	for (Eigen::Index k = 0; k < combine.rows(); ++k)
	{
		Eigen::VectorXd combination = Eigen::VectorXd::Zero(J_.cols());
		for (size_t i = 0; i < columns.size(); ++i) combination[columns[i]] = combine(k, static_cast<Eigen::Index>(i));
		const Eigen::VectorXd change = ldlt_.solve(combination);
		const Variance v = variance(factors, J_ * change, stretch);
		const double allowed = trust.track_factor * v.single;
		const double together = allowed > 0 ? std::max({1.0, v.by_tracks / allowed, v.by_stretches / allowed}) : 1;
		result.sigma[k] = std::sqrt(v.others + together * v.images);
		if (v.single > 0) track_factors.push_back(v.by_tracks / v.single);
	}
	if (track_factors.empty()) return result;
	result.track_factor = upperMedian(track_factors);
	return result;
}

BatchInformation::Variance BatchInformation::variance(const std::vector<BatchFactor>& factors, const Eigen::VectorXd& influence,
                                                      const std::vector<int>& stretch) const
{
	Variance v;
	double pull_of_track = 0;
	const double* track = nullptr;  // sightings of one landmark follow each other
	std::map<int, double> pull_of_stretch;
	for (size_t i = 0; i < rows_.size(); ++i)
	{
		const auto k = static_cast<Eigen::Index>(i);
		const double square_influence = square(influence[k]);
		if (rows_[i].group != BatchGroup::image)
		{
			v.others += square_influence;
			continue;
		}
		const double pull = influence[k] * residual_[k];
		v.images += square_influence;
		v.single += square(pull);
		const auto f = static_cast<size_t>(rows_[i].factor);
		if (track != factors[f].factor.blocks.back())
		{
			v.by_tracks += square(pull_of_track);
			pull_of_track = 0;
			track = factors[f].factor.blocks.back();
		}
		pull_of_track += pull;
		pull_of_stretch[stretch[f]] += pull;
	}
	v.by_tracks += square(pull_of_track);
	for (const auto& [number, pull] : pull_of_stretch) v.by_stretches += square(pull);
	return v;
}

double BatchInformation::varianceFactor(BatchGroup group, const std::function<bool(int row)>& counts, bool by_median) const
{
	constexpr int kProbes = 4;
	constexpr double kMedianOfSquare = 0.4549;  // of a standard normal number
	std::vector<Eigen::Index> rows;
	std::vector<double> squares;
	for (size_t i = 0; i < rows_.size(); ++i)
	{
		if (rows_[i].group != group || !counts(rows_[i].row)) continue;
		rows.push_back(static_cast<Eigen::Index>(i));
		squares.push_back(square(residual_[rows.back()]));
	}
	if (rows.empty()) return 1;
	std::mt19937_64 generator(1);
	double trace = 0;
	for (int probe = 0; probe < kProbes; ++probe)
	{
		Eigen::VectorXd signs = Eigen::VectorXd::Zero(J_.rows());
		for (const Eigen::Index row : rows) signs[row] = (generator() & 1) != 0 ? 1 : -1;
		const Eigen::VectorXd projected = J_.transpose() * signs;
		trace += projected.dot(ldlt_.solve(projected)) / kProbes;
	}
	const auto number = static_cast<double>(rows.size());
	if (number - trace < 1) return 1;
	if (!by_median) return std::accumulate(squares.begin(), squares.end(), 0.0) / (number - trace);
	return upperMedian(squares) / kMedianOfSquare * number / (number - trace);
}
}  // namespace viwo
