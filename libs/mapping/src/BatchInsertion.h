#pragma once

#include "CellUpdates.h"

#include <algorithm>

namespace viwo
{
/** Walks the tree once for many changes. What updateNode() of liboctomap would do for each in turn, with pruning, is done here for all: a
 *  branch is opened, changed and closed once, as every voxel's value depends on its own changes alone.
 */
template <class Tree>
class BatchInsertion
{
   public:
	using Node = typename Tree::NodeType;

	/** @param updates sorted. */
	BatchInsertion(Tree& tree, const std::vector<CellUpdate>& updates) : tree_(tree), updates_(updates) {}

	void run()
	{
		if (updates_.empty()) return;
		size_t first = 0;
		if (!tree_.getRoot()) tree_.updateNode(keyOf(updates_[first++]), isHit(updates_[0]));
		if (first < updates_.size()) apply(tree_.getRoot(), false, first, updates_.size(), 0);
	}

   private:
	void apply(Node* node, bool just_created, size_t begin, size_t end, unsigned depth)
	{
		if (depth == tree_.getTreeDepth())
		{
			for (size_t i = begin; i < end; ++i)
				tree_.updateNodeLogOdds(node, isHit(updates_[i]) ? tree_.getProbHitLog() : tree_.getProbMissLog());
			return;
		}
		if (!just_created && !tree_.nodeHasChildren(node))
		{
			if (changesNothing(*node, begin, end)) return;
			tree_.expandNode(node);
		}
		while (begin < end)
		{
			const unsigned child = childOf(updates_[begin], depth);
			const size_t next = endOfChild(child, begin, end, depth);
			const bool exists = tree_.nodeChildExists(node, child);
			apply(exists ? tree_.getNodeChild(node, child) : tree_.createNodeChild(node, child), !exists, begin, next, depth + 1);
			begin = next;
		}
		if (!tree_.pruneNode(node)) node->updateOccupancyChildren();
	}

	size_t endOfChild(unsigned child, size_t begin, size_t end, unsigned depth) const
	{
		if (childOf(updates_[end - 1], depth) == child) return end;
		const auto after =
		    std::partition_point(updates_.begin() + static_cast<std::ptrdiff_t>(begin), updates_.begin() + static_cast<std::ptrdiff_t>(end),
		                         [&](CellUpdate u) { return childOf(u, depth) <= child; });
		return static_cast<size_t>(after - updates_.begin());
	}

	/** A pruned node at a clamping limit that all changes push against. */
	bool changesNothing(const Node& node, size_t begin, size_t end) const
	{
		const bool at_max = node.getLogOdds() >= tree_.getClampingThresMaxLog(),
		           at_min = node.getLogOdds() <= tree_.getClampingThresMinLog();
		if (!at_max && !at_min) return false;
		return std::all_of(updates_.begin() + static_cast<std::ptrdiff_t>(begin), updates_.begin() + static_cast<std::ptrdiff_t>(end),
		                   [&](CellUpdate u) { return isHit(u) ? at_max : at_min; });
	}

	Tree& tree_;
	const std::vector<CellUpdate>& updates_;
};
}  // namespace viwo
