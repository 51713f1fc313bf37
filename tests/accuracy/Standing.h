#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** Ten minutes of standing between two drives. */
class Standing : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
