#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** Logs that begin in mid-motion: straight, arc, rotation on the spot, standing. What is known at the first pose, and the ten seconds
 * after. */
class Starts : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
