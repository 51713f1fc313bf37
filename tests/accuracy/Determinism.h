#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** The same log three times, once beside a busy machine. */
class Determinism : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
