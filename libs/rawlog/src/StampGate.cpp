#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/StampGate.h>

#include <algorithm>

using mrpt::obs::CObservation;

namespace viwo
{
namespace
{
/** The stream has gone on at its old place when it has come this far since the jump: longer than any sensor's data are late. */
constexpr double kGoesOn_s = 1;
/** It has gone on at a new place when this much has come there while it has not gone on at the old one. */
constexpr double kConfirmed_s = 2;
/** More than any robot sends in that time: such stamps have no order at all. */
constexpr size_t kMostHeld = 10000;
}  // namespace

bool StampGate::near(int64_t a_ns, int64_t b_ns) const
{
	return std::abs(secondsBetween(a_ns, b_ns)) <= max_jump_s_;
}

double StampGate::spanAround_s(int64_t t_ns) const
{
	int64_t first_ns = t_ns, last_ns = t_ns;
	for (const Held& h : held_)
	{
		if (!near(h.t_ns, t_ns)) continue;
		first_ns = std::min(first_ns, h.t_ns);
		last_ns = std::max(last_ns, h.t_ns);
	}
	return secondsBetween(first_ns, last_ns);
}

size_t StampGate::countAround(int64_t t_ns) const
{
	return static_cast<size_t>(std::count_if(held_.begin(), held_.end(), [&](const Held& h) { return near(h.t_ns, t_ns); }));
}

void StampGate::moveTo(int64_t t_ns, Verdict& verdict)
{
	int64_t newest_ns = t_ns;
	for (const Held& h : held_)
	{
		const bool passes = near(h.t_ns, t_ns);
		(passes ? verdict.passed : verdict.rejected).push_back(h.observation);
		if (passes) newest_ns = std::max(newest_ns, h.t_ns);
	}
	held_.clear();
	stream_ns_ = newest_ns;
}

void StampGate::rejectHeld(Verdict& verdict)
{
	for (const Held& h : held_) verdict.rejected.push_back(h.observation);
	held_.clear();
}

StampGate::Verdict StampGate::push(const CObservation::Ptr& observation)
{
	Verdict verdict;
	const int64_t t_ns = nanosecondsOf(observation->timestamp);
	if (!stream_ns_ && (trusts_first_ || max_jump_s_ <= 0)) stream_ns_ = t_ns;
	if (max_jump_s_ <= 0 || (stream_ns_ && near(t_ns, *stream_ns_)))
	{
		verdict.passed.push_back(observation);
		stream_ns_ = std::max(*stream_ns_, t_ns);
		if (!held_.empty() && secondsBetween(stream_at_hold_ns_, *stream_ns_) > kGoesOn_s) rejectHeld(verdict);
		return verdict;
	}
	if (held_.empty()) stream_at_hold_ns_ = stream_ns_.value_or(t_ns);
	held_.push_back({t_ns, observation});
	if (spanAround_s(t_ns) >= kConfirmed_s)
		moveTo(t_ns, verdict);
	else if (held_.size() > kMostHeld)
		rejectHeld(verdict);
	return verdict;
}

StampGate::Verdict StampGate::finish()
{
	Verdict verdict;
	if (stream_ns_)
		rejectHeld(verdict);
	else if (!held_.empty())
	{
		// A log too short to be sure: most of it is right.
		const auto fewer = [&](const Held& a, const Held& b) { return countAround(a.t_ns) < countAround(b.t_ns); };
		moveTo(std::max_element(held_.begin(), held_.end(), fewer)->t_ns, verdict);
	}
	return verdict;
}
}  // namespace viwo
