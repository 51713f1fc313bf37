#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** Straight lines and a rotation on the spot: all three modes. */
class Corridor : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
