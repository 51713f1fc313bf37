#include "StampRepair.h"

#include <algorithm>
#include <cstdlib>

namespace viwo
{
namespace
{
constexpr int64_t kTick_ns = 100;

/** Neighbouring stamps that share one place on the line of time. */
struct Pool
{
	double sum_ns;
	size_t count;
	double mean_ns() const { return sum_ns / static_cast<double>(count); }
};

std::vector<Pool> pooled(const std::vector<int64_t>& t_ns)
{
	std::vector<Pool> pools;
	for (const int64_t t : t_ns)
	{
		pools.push_back({static_cast<double>(t - t_ns.front()), 1});
		while (pools.size() > 1 && pools[pools.size() - 2].mean_ns() >= pools.back().mean_ns())
		{
			const Pool last = pools.back();
			pools.pop_back();
			pools.back().sum_ns += last.sum_ns;
			pools.back().count += last.count;
		}
	}
	return pools;
}
}  // namespace

RepairedStamps repairStamps(const std::vector<int64_t>& t_ns)
{
	RepairedStamps result;
	if (t_ns.empty()) return result;
	result.t_ns.reserve(t_ns.size());
	const std::vector<Pool> pools = pooled(t_ns);
	for (size_t p = 0; p < pools.size(); ++p)
	{
		const double mean = pools[p].mean_ns();
		const double before = p > 0 ? mean - pools[p - 1].mean_ns() : 1e9;
		const double after = p + 1 < pools.size() ? pools[p + 1].mean_ns() - mean : 1e9;
		const double width = std::min(before, after), slots = static_cast<double>(pools[p].count);
		for (size_t i = 0; i < pools[p].count; ++i)
		{
			const double offset = pools[p].count == 1 ? 0 : width * ((static_cast<double>(i) + 0.5) / slots - 0.5);
			// A lone stamp keeps its value to the nanosecond: the mean of a pool would round it.
			const int64_t exact = pools[p].count == 1 ? t_ns[result.t_ns.size()] : t_ns.front() + static_cast<int64_t>(mean + offset);
			int64_t t = (exact + (exact < 0 ? -kTick_ns : kTick_ns) / 2) / kTick_ns * kTick_ns;
			if (!result.t_ns.empty()) t = std::max(t, result.t_ns.back() + kTick_ns);
			result.t_ns.push_back(t);
		}
	}
	for (size_t i = 0; i < t_ns.size(); ++i)
	{
		if (i > 0 && t_ns[i] <= t_ns[i - 1]) ++result.backwards;
		const int64_t change = std::abs(result.t_ns[i] - t_ns[i]);
		if (change >= kTick_ns) ++result.changed;
		result.largest_change_ns = std::max(result.largest_change_ns, change);
	}
	return result;
}
}  // namespace viwo
