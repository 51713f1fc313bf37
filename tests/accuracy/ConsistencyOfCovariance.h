#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** Whether errors are as large as the covariances say, with wheels drawn from the estimator's priors. */
class ConsistencyOfCovariance : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
