#pragma once

#include <viwo/core/Pose3.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace viwo
{
/** Frames and the transforms between them, as tf tells them. A sensor's pose is where the first messages put it; how far it moved after
 * that is kept. Names are compared without a leading slash. */
class FrameTree
{
   public:
	/** The transform from parent to child: T_parent_child. */
	void add(const std::string& parent, const std::string& child, const Pose3& T_parent_child);

	/** T_from_to by the first transform of each edge; nothing when no chain of transforms leads there. */
	std::optional<Pose3> find(const std::string& from, const std::string& to) const;

	/** Whether any transform names the frame. */
	bool has(const std::string& frame) const;
	std::set<std::string> names() const;

	struct Motion
	{
		double translation_m = 0, rotation_rad = 0;
	};
	/** The largest change of an edge on the chain between two frames since its first transform. */
	Motion motionBetween(const std::string& from, const std::string& to) const;

	static std::string plainName(const std::string& frame);

   private:
	struct Edge
	{
		std::string parent;
		Pose3 T_parent_child;
		Motion motion;
	};
	/** Frames from `frame` up to its root. */
	std::vector<std::string> ancestry(const std::string& frame) const;

	std::map<std::string, Edge> edges_;  //!< by child
};
}  // namespace viwo
