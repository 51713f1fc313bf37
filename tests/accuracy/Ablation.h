#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** One part of the estimator off at a time. */
class Ablation : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
