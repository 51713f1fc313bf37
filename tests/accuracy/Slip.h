#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** One wheel turns 30 % too much for two seconds; each run is compared with that of the same seed without slip. */
class Slip : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
