#include <viwo/odometry/StageTimes.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <numeric>

namespace viwo
{
void StageTimes::begin(const std::string& stage)
{
	stages_[stage].begin = std::chrono::steady_clock::now();
}

void StageTimes::end(const std::string& stage) noexcept
try
{
	const auto it = stages_.find(stage);
	if (it == stages_.end()) return;
	it->second.ms.push_back(std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - it->second.begin).count());
}
catch (const std::exception&)
{
}

StageTimes::Statistics StageTimes::statistics(const std::string& stage) const
{
	return statistics(stage, 0, std::numeric_limits<size_t>::max());
}

StageTimes::Statistics StageTimes::statistics(const std::string& stage, size_t from, size_t to) const
{
	Statistics result;
	const auto it = stages_.find(stage);
	if (it == stages_.end()) return result;
	const auto at = [&](size_t i) { return it->second.ms.begin() + static_cast<std::ptrdiff_t>(std::min(i, it->second.ms.size())); };
	if (at(from) >= at(to)) return result;
	std::vector<float> ms(at(from), at(to));
	std::sort(ms.begin(), ms.end());
	const auto quantile = [&](double q) { return static_cast<double>(ms[static_cast<size_t>(q * static_cast<double>(ms.size() - 1))]); };
	result.calls = ms.size();
	result.mean_ms = std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
	result.median_ms = quantile(0.5);
	result.p95_ms = quantile(0.95);
	result.max_ms = static_cast<double>(ms.back());
	return result;
}

std::vector<std::string> StageTimes::stages() const
{
	std::vector<std::string> names;
	for (const auto& [name, stage] : stages_) names.push_back(name);
	return names;
}
}  // namespace viwo
