#include "StatusLog.h"

#include <viwo/core/Time.h>

namespace viwo
{
const char* toString(Status status)
{
	switch (status)
	{
		case Status::waiting: return "waiting";
		case Status::initialising: return "initialising";
		case Status::from_wheels: return "from_wheels";
		case Status::tracking: return "tracking";
		case Status::dead_reckoning: return "dead_reckoning";
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

void StatusLog::update(int64_t t_ns, int known_landmarks, bool has_camera)
{
	if (!has_camera) return;
	const std::string count = std::to_string(known_landmarks) + " landmarks of known depth";
	if (known_landmarks >= options_.tracking_min_landmarks)
	{
		last_good_ns_ = t_ns;
		set(Status::tracking, t_ns, count);
	}
	// Between the two thresholds nothing changes: a status that flickers tells nobody anything.
	if (known_landmarks >= options_.tracking_min_landmarks / 3) last_good_ns_ = t_ns;
	if (now_ == Status::tracking && secondsBetween(last_good_ns_, t_ns) > options_.dead_reckoning_after_s)
		set(Status::dead_reckoning, t_ns, "only " + count + " for " + std::to_string(secondsBetween(last_good_ns_, t_ns)).substr(0, 4) + " s");
}
}  // namespace viwo
