#include "StreamClock.h"

#include <viwo/core/Time.h>

namespace viwo
{
void StreamClock::advance(int64_t t_ns)
{
	if (started_ && t_ns <= now_ns_) return;
	if (started_ && secondsBetween(now_ns_, t_ns) > longest_fill_s_) holes_.push_back({now_ns_ + nanoseconds(longest_fill_s_), t_ns});
	started_ = true;
	now_ns_ = t_ns;
}

int64_t StreamClock::pastHoles(int64_t t_ns)
{
	while (!holes_.empty() && holes_.front().end_ns <= t_ns) holes_.pop_front();
	return !holes_.empty() && t_ns > holes_.front().begin_ns ? holes_.front().end_ns : t_ns;
}
}  // namespace viwo
