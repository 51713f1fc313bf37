#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** A constant arc, in motion from the first sample on: all three modes. */
class Lobby : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
