#include <viwo/rawlog/MrptTime.h>

#include <algorithm>
#include <limits>

namespace viwo
{
namespace
{
constexpr int64_t kNanosecondsPerTick = 100;
/** From MRPT's epoch, 1601-01-01, to that of Unix. */
constexpr int64_t kUnixEpoch_ticks = 116444736000000000;
/** 97 years either side of 1970, so that differences of two stamps do not overflow either. */
constexpr int64_t kLargest_ticks = std::numeric_limits<int64_t>::max() / (3 * kNanosecondsPerTick);
}  // namespace

int64_t nanosecondsOf(mrpt::Clock::time_point stamp)
{
	return std::clamp(stamp.time_since_epoch().count() - kUnixEpoch_ticks, -kLargest_ticks, kLargest_ticks) * kNanosecondsPerTick;
}

mrpt::Clock::time_point mrptTime(int64_t t_ns)
{
	int64_t ticks = t_ns / kNanosecondsPerTick;
	const int64_t rest_ns = t_ns % kNanosecondsPerTick;
	if (rest_ns >= kNanosecondsPerTick / 2) ticks++;
	if (rest_ns < -kNanosecondsPerTick / 2) ticks--;
	return mrpt::Clock::time_point(mrpt::Clock::duration(ticks + kUnixEpoch_ticks));
}
}  // namespace viwo
