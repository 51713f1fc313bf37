#include "StatusLog.h"

#include <viwo/core/Time.h>

namespace viwo
{
namespace
{
constexpr int kCameraLost = 8;
}

const char* toString(Status status)
{
	switch (status)
	{
		case Status::waiting:
			return "waiting";
		case Status::initialising:
			return "initialising";
		case Status::from_wheels:
			return "from_wheels";
		case Status::tracking:
			return "tracking";
		case Status::dead_reckoning:
			return "dead_reckoning";
	}
	return "unknown";
}

void StatusLog::set(Status to, int64_t t_ns, const std::string& cause)
{
	if (to == now_) return;
	changes_.push_back({t_ns, now_, to, cause});
	now_ = to;
	last_good_ns_ = t_ns;
}

void StatusLog::update(int64_t t_ns, int known, int seen)
{
	if (seen >= kCameraLost) last_good_ns_ = t_ns;
	if (known >= options_.tracking_min_landmarks)
		set(Status::tracking, t_ns, std::to_string(known) + " landmarks of known depth");
	else if (now_ == Status::tracking && secondsBetween(last_good_ns_, t_ns) > options_.dead_reckoning_after_s)
		set(Status::dead_reckoning, t_ns,
		    "fewer than " + std::to_string(kCameraLost) + " landmarks in sight for " +
		        std::to_string(secondsBetween(last_good_ns_, t_ns)).substr(0, 4) + " s");
}
}  // namespace viwo
