#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace viwo
{
/** The value that `rank` others precede in order of size. Reorders the values. @pre rank < values.size() */
template <class T>
T valueAtRank(std::vector<T>& values, size_t rank)
{
	const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
	std::nth_element(values.begin(), at, values.end());
	return *at;
}

/** The median; the upper one of the two in the middle of an even number, so that it is always one of the values. Reorders them.
 *  @pre not empty */
template <class T>
T upperMedian(std::vector<T>& values)
{
	return valueAtRank(values, values.size() / 2);
}
}  // namespace viwo
