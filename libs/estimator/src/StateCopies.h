#pragma once

#include "FactorSet.h"

#include <algorithm>
#include <unordered_map>
#include <vector>

namespace viwo
{
/** The blocks of some factors, copied into one array. Ceres orders the blocks of a group by their addresses: in the order of the factors
 * they make that order repeatable. */
class StateCopies
{
   public:
	explicit StateCopies(const std::vector<Factor>& factors)
	{
		size_t size = 0;
		for (const Factor& factor : factors)
			for (size_t i = 0; i < factor.blocks.size(); ++i)
			{
				const BlockShape& shape = factor.cost->shapes()[i];
				if (!offsets_.emplace(factor.blocks[i], size).second) continue;
				states_.push_back({factor.blocks[i], shape});
				size += static_cast<size_t>(shape.ambient);
			}
		values_.reserve(size);
		for (const State& s : states_) values_.insert(values_.end(), s.original, s.original + s.shape.ambient);
	}

	struct State
	{
		double* original;
		BlockShape shape;
	};
	const std::vector<State>& states() const { return states_; }
	double* copyOf(const double* original) { return values_.data() + offsets_.at(original); }
	void writeBack()
	{
		for (const State& s : states_) std::copy_n(copyOf(s.original), s.shape.ambient, s.original);
	}

   private:
	std::unordered_map<const double*, size_t> offsets_;  // looked up only, never walked through
	std::vector<State> states_;
	std::vector<double> values_;
};
}  // namespace viwo
