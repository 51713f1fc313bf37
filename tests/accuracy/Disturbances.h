#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** Black images, silent wheels, jittered stamps, a step of the exposure; each run is compared with the clean one of the same seed. */
class Disturbances : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};
}  // namespace viwo::accuracy
