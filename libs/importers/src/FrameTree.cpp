#include "FrameTree.h"

#include <algorithm>

namespace viwo
{
std::string FrameTree::plainName(const std::string& frame)
{
	return frame.empty() || frame[0] != '/' ? frame : frame.substr(1);
}

void FrameTree::add(const std::string& parent, const std::string& child, const Pose3& T_parent_child)
{
	const auto [at, is_new] = edges_.try_emplace(plainName(child), Edge{plainName(parent), T_parent_child, {}});
	if (is_new) return;
	const Pose3& first = at->second.T_parent_child;
	Motion& motion = at->second.motion;
	motion.translation_m = std::max(motion.translation_m, (T_parent_child.p - first.p).norm());
	motion.rotation_rad = std::max(motion.rotation_rad, first.R.angularDistance(T_parent_child.R));
}

bool FrameTree::has(const std::string& frame) const
{
	const std::string name = plainName(frame);
	return edges_.count(name) > 0 || std::any_of(edges_.begin(), edges_.end(), [&](const auto& e) { return e.second.parent == name; });
}

std::set<std::string> FrameTree::names() const
{
	std::set<std::string> names;
	for (const auto& [child, edge] : edges_) names.insert({child, edge.parent});
	return names;
}

std::vector<std::string> FrameTree::ancestry(const std::string& frame) const
{
	std::vector<std::string> chain{plainName(frame)};
	// A damaged tf may go round in circles.
	while (chain.size() <= edges_.size())
	{
		const auto edge = edges_.find(chain.back());
		if (edge == edges_.end()) break;
		chain.push_back(edge->second.parent);
	}
	return chain;
}

std::optional<Pose3> FrameTree::find(const std::string& from, const std::string& to) const
{
	const auto up_from = ancestry(from), up_to = ancestry(to);
	const auto toAncestor = [this](const std::vector<std::string>& chain, const std::string& ancestor)
	{
		Pose3 T_ancestor_frame;
		for (const std::string& frame : chain)
		{
			if (frame == ancestor) break;
			T_ancestor_frame = edges_.at(frame).T_parent_child * T_ancestor_frame;
		}
		return T_ancestor_frame;
	};
	for (const std::string& common : up_from)
		if (std::find(up_to.begin(), up_to.end(), common) != up_to.end())
			return toAncestor(up_from, common).inverse() * toAncestor(up_to, common);
	return std::nullopt;
}

FrameTree::Motion FrameTree::motionBetween(const std::string& from, const std::string& to) const
{
	const auto up_from = ancestry(from), up_to = ancestry(to);
	Motion largest;
	const auto collect = [&](const std::vector<std::string>& chain, const std::vector<std::string>& other)
	{
		for (const std::string& frame : chain)
		{
			if (std::find(other.begin(), other.end(), frame) != other.end()) return;
			const Motion& motion = edges_.at(frame).motion;
			largest.translation_m = std::max(largest.translation_m, motion.translation_m);
			largest.rotation_rad = std::max(largest.rotation_rad, motion.rotation_rad);
		}
	};
	if (!find(from, to)) return largest;
	collect(up_from, up_to);
	collect(up_to, up_from);
	return largest;
}
}  // namespace viwo
