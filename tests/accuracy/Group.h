#pragma once

#include <viwo/core/Error.h>

#include <memory>
#include <string>
#include <vector>

#include <viwo/experiments/Runner.h>
#include "Results.h"

namespace viwo::accuracy
{
using namespace experiments;

/** What holds for all rows. */
struct Settings
{
	int seeds = 5;
	std::string folder;     //!< of the results: for files that the runs need
	std::string test_data;  //!< folder of real recordings; empty: there are none
};

/** Rows that belong together: which runs they need, and what the runs show. */
class Group
{
   public:
	explicit Group(Settings settings) : settings_(std::move(settings)) {}
	virtual ~Group() = default;

	/** Names of the rows, in their order. */
	virtual std::vector<std::string> bars() const = 0;
	virtual void plan(Runner& runner) const = 0;
	/** One row for each bar. @throws Error for outputs that are missing. */
	virtual std::vector<Row> judge(const Runner& runner) const = 0;

   protected:
	Settings settings_;
};
}  // namespace viwo::accuracy
