#pragma once

#include <cmath>
#include <cstdint>

namespace viwo
{
/** Stamps are `int64_t t_ns`, nanoseconds of Unix time; durations are `double` seconds. */
constexpr double kNanosecondsPerSecond = 1e9;

/** Duration t_end_ns - t_begin_ns in seconds; exact in the integers, so safe at Unix epoch. */
inline double secondsBetween(int64_t t_begin_ns, int64_t t_end_ns)
{
	return static_cast<double>(t_end_ns - t_begin_ns) / kNanosecondsPerSecond;
}

inline int64_t nanoseconds(double seconds)
{
	return static_cast<int64_t>(std::llround(seconds * kNanosecondsPerSecond));
}
}  // namespace viwo
