#include "SampleBuffer.h"

#include <viwo/core/Time.h>

#include <algorithm>
#include <limits>

namespace viwo
{
namespace
{
template <class Sample>
bool appendLater(std::deque<Sample>& samples, const Sample& sample)
{
	if (!samples.empty() && sample.t_ns <= samples.back().t_ns) return false;
	samples.push_back(sample);
	return true;
}

template <class Sample>
bool coversTime(const std::deque<Sample>& samples, int64_t t_ns)
{
	return !samples.empty() && samples.front().t_ns <= t_ns && t_ns <= samples.back().t_ns;
}

/** Index of the first sample later than t_ns. */
template <class Sample>
size_t firstAfter(const std::deque<Sample>& samples, int64_t t_ns)
{
	const auto it = std::upper_bound(samples.begin(), samples.end(), t_ns, [](int64_t t, const Sample& s) { return t < s.t_ns; });
	return static_cast<size_t>(it - samples.begin());
}

template <class Sample>
void dropUnneeded(std::deque<Sample>& samples, int64_t t_ns)
{
	const size_t later = firstAfter(samples, t_ns);
	if (later > 1) samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(later - 1));
}

template <class Sample>
int64_t latestStamp(const std::deque<Sample>& samples)
{
	return samples.empty() ? std::numeric_limits<int64_t>::min() : samples.back().t_ns;
}

/** Share of the way from `before` to `after`. */
double fraction(int64_t before_ns, int64_t after_ns, double t_since_before_ns)
{
	return t_since_before_ns / static_cast<double>(after_ns - before_ns);
}
}  // namespace

bool ImuBuffer::add(const ImuSample& sample)
{
	return appendLater(samples_, sample);
}

bool ImuBuffer::covers(int64_t t_ns) const
{
	return coversTime(samples_, t_ns);
}

void ImuBuffer::dropBefore(int64_t t_ns)
{
	dropUnneeded(samples_, t_ns);
}

int64_t ImuBuffer::latest_ns() const
{
	return latestStamp(samples_);
}

ImuSample ImuBuffer::at(int64_t t_ns) const
{
	const size_t next = firstAfter(samples_, t_ns);
	const ImuSample& before = samples_[next - 1];
	if (before.t_ns == t_ns) return before;
	const ImuSample& after = samples_[next];
	const double u = fraction(before.t_ns, after.t_ns, static_cast<double>(t_ns - before.t_ns));
	return {t_ns, (1 - u) * before.acc_m_s2 + u * after.acc_m_s2, (1 - u) * before.gyro_rad_s + u * after.gyro_rad_s};
}

std::optional<std::vector<ImuSample>> ImuBuffer::span(int64_t t_begin_ns, int64_t t_end_ns, double max_gap_s) const
{
	if (t_begin_ns >= t_end_ns || !covers(t_begin_ns) || !covers(t_end_ns)) return std::nullopt;
	std::vector<ImuSample> result{at(t_begin_ns)};
	for (size_t i = firstAfter(samples_, t_begin_ns);; ++i)
	{
		if (secondsBetween(samples_[i - 1].t_ns, samples_[i].t_ns) > max_gap_s) return std::nullopt;
		if (samples_[i].t_ns >= t_end_ns) break;
		result.push_back(samples_[i]);
	}
	result.push_back(at(t_end_ns));
	return result;
}

bool WheelBuffer::add(const WheelSample& sample)
{
	return appendLater(samples_, sample);
}

bool WheelBuffer::covers(int64_t t_ns) const
{
	return coversTime(samples_, t_ns);
}

void WheelBuffer::dropBefore(int64_t t_ns)
{
	dropUnneeded(samples_, t_ns);
}

int64_t WheelBuffer::latest_ns() const
{
	return latestStamp(samples_);
}

std::optional<std::vector<WheelSegment>> WheelBuffer::segments(int64_t t_begin_ns, int64_t t_end_ns, double max_gap_s) const
{
	if (t_begin_ns >= t_end_ns || !covers(t_begin_ns) || !covers(t_end_ns)) return std::nullopt;
	std::vector<WheelSegment> result;
	for (size_t i = firstAfter(samples_, t_begin_ns);; ++i)
	{
		const WheelSample &before = samples_[i - 1], &after = samples_[i];
		if (secondsBetween(before.t_ns, after.t_ns) > max_gap_s) return std::nullopt;
		const double dt_s = secondsBetween(std::max(before.t_ns, t_begin_ns), std::min(after.t_ns, t_end_ns));
		result.push_back({dt_s, after.v_left_m_s, after.v_right_m_s});
		if (after.t_ns >= t_end_ns) break;
	}
	return result;
}
}  // namespace viwo
