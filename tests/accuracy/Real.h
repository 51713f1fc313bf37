#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** Recordings of real cars and copters, where they are at hand. */
class Real : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
