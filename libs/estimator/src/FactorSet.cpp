#include "FactorSet.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viwo
{
void FactorSet::add(Factor factor)
{
	factors_.push_back(std::move(factor));
}

void FactorSet::eliminate(double* block)
{
	to_eliminate_.insert(block);
}

void FactorSet::prepare()
{
	collectBlocks();
	freezeFactors();
	assignColumns();
}

size_t FactorSet::indexOf(double* data, const BlockShape& shape)
{
	const auto [entry, is_new] = index_.try_emplace(data, blocks_.size());
	if (is_new)
	{
		const bool eliminated = to_eliminate_.count(data) > 0;
		blocks_.push_back({data, shape, nullptr, eliminated, eliminated && shape.tangent == 1, 0});
	}
	return entry->second;
}

void FactorSet::collectBlocks()
{
	for (const Factor& factor : factors_)
	{
		std::vector<size_t> ids, landmarks;
		for (size_t i = 0; i < factor.blocks.size(); ++i)
		{
			const size_t id = indexOf(factor.blocks[i], factor.cost->shapes()[i]);
			ids.push_back(id);
			if (blocks_[id].eliminated && blocks_[id].shape.tangent == 1) landmarks.push_back(id);
			if (!blocks_[id].x0) blocks_[id].x0 = factor.cost->linearizationPoint(static_cast<int>(i));
		}
		if (landmarks.size() > 1)
			for (const size_t id : landmarks) blocks_[id].landmark = false;
		factor_blocks_.push_back(std::move(ids));
	}
}

void FactorSet::freezeFactors()
{
	// The points may belong to one of the costs: copied, lest a cost drops its own while it is being frozen anew.
	std::vector<std::vector<double>> points(blocks_.size());
	for (size_t id = 0; id < blocks_.size(); ++id)
		if (blocks_[id].x0) points[id].assign(blocks_[id].x0, blocks_[id].x0 + blocks_[id].shape.ambient);
	for (size_t f = 0; f < factors_.size(); ++f)
		for (size_t i = 0; i < factor_blocks_[f].size(); ++i)
		{
			const auto& point = points[factor_blocks_[f][i]];
			LocalCost& cost = *factors_[f].cost;
			const double* held = cost.linearizationPoint(static_cast<int>(i));
			if (!point.empty() && !(held && std::equal(point.begin(), point.end(), held))) cost.freeze(static_cast<int>(i), point.data());
		}
	for (size_t f = 0; f < factors_.size(); ++f)
		for (size_t i = 0; i < factor_blocks_[f].size(); ++i)
			blocks_[factor_blocks_[f][i]].x0 = factors_[f].cost->linearizationPoint(static_cast<int>(i));
}

void FactorSet::assignColumns()
{
	for (Block& block : blocks_)
		if (block.landmark) block.column = landmarks_++;
	for (const bool eliminated : {true, false})
	{
		for (Block& block : blocks_)
		{
			if (block.landmark || block.eliminated != eliminated) continue;
			block.column = columns_;
			columns_ += block.shape.tangent;
		}
		if (eliminated) eliminated_columns_ = columns_;
	}
}

int FactorSet::landmarkOf(size_t factor) const
{
	for (const size_t id : factor_blocks_[factor])
		if (blocks_[id].landmark) return blocks_[id].column;
	return -1;
}

bool FactorSet::linearize(size_t f)
{
	const Factor& factor = factors_[f];
	const std::vector<size_t>& ids = factor_blocks_[f];
	const Eigen::Index rows = rowsOf(f);
	pointers_.resize(ids.size());
	widths_.resize(ids.size());
	Eigen::Index columns = 0;
	for (size_t i = 0; i < ids.size(); ++i) columns += widths_[i] = blocks_[ids[i]].shape.tangent;
	workspace_.resize(static_cast<size_t>(rows * columns));
	double* next = workspace_.data();
	for (size_t i = 0; i < ids.size(); ++i) pointers_[i] = std::exchange(next, next + rows * widths_[i]);
	residual_.resize(rows);
	if (!factor.cost->linearize(factor.blocks.data(), residual_.data(), pointers_.data()))
	{
		++skipped_factors_;
		return false;
	}
	if (factor.loss) applyLoss(*factor.loss);
	return true;
}

/** Weighs by the derivative of the loss (Triggs et al., "Bundle adjustment: a modern synthesis", Sec. 4.3), with Ceres' rule: no
 *  second-order term where the loss curves downwards. */
void FactorSet::applyLoss(const ceres::LossFunction& loss)
{
	const double squared_norm = residual_.squaredNorm();
	double rho[3];
	loss.Evaluate(squared_norm, rho);
	const double root = std::sqrt(rho[1]);
	const bool second_order = squared_norm > 0 && rho[2] > 0;
	const double alpha = second_order ? 1 - std::sqrt(1 + 2 * squared_norm * rho[2] / rho[1]) : 0;
	for (size_t i = 0; i < pointers_.size(); ++i)
	{
		Eigen::Map<RowMajorMatrix> J(pointers_[i], residual_.size(), widths_[i]);
		if (second_order)
		{
			const Eigen::RowVectorXd radial = residual_.transpose() * J;
			J -= (alpha / squared_norm) * residual_ * radial;
		}
		J *= root;
	}
	residual_ *= root / (1 - alpha);
}
}  // namespace viwo
