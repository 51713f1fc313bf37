#pragma once

#include <viwo/core/Ranking.h>

#include <vector>

namespace viwo
{
/** The upper one of an even number of values; 0 for none. */
inline double medianOf(std::vector<double> values)
{
	return values.empty() ? 0 : upperMedian(values);
}
}  // namespace viwo
