#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** One program at a time on an idle machine; and ten minutes of driving. */
class SpeedAndMemory : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
