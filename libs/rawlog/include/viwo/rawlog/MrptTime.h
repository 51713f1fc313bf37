#pragma once

#include <mrpt/core/Clock.h>

#include <cstdint>

namespace viwo
{
/** Unix nanoseconds of an MRPT stamp, exact; stamps beyond 97 years from 1970 are clamped there. */
int64_t nanosecondsOf(mrpt::Clock::time_point stamp);

/** MRPT's clock ticks in 100 ns: rounds to the nearest, so nanosecondsOf(mrptTime(t)) differs from t by up to 50 ns. */
mrpt::Clock::time_point mrptTime(int64_t t_ns);

/** t_ns as it comes back from a rawlog. */
inline int64_t roundedToRawlog(int64_t t_ns)
{
	return nanosecondsOf(mrptTime(t_ns));
}
}  // namespace viwo
