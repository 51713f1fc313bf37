#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace viwo
{
/** Stamps in the order of a file that is known to be the true one, made strictly increasing. */
struct RepairedStamps
{
	std::vector<int64_t> t_ns;  //!< multiples of 100 ns, what a rawlog can hold
	size_t backwards = 0;       //!< stamps that were not later than the one before
	size_t changed = 0;         //!< stamps moved by more than that rounding
	int64_t largest_change_ns = 0;
};

/** The increasing sequence nearest to the stamps in the sense of least squares (pool adjacent violators; Barlow et al., "Statistical
 * inference under order restrictions", 1972); stamps that it makes equal are spread evenly over the space between their neighbours.
 */
RepairedStamps repairStamps(const std::vector<int64_t>& t_ns);
}  // namespace viwo
