#include "GapLog.h"

#include <viwo/core/Time.h>

#include <algorithm>

namespace viwo
{
GapLog::GapLog(const OdometryOptions& options)
{
	const EstimatorOptions& e = options.estimator;
	if (e.useCamera()) longest_s_[options.rawlog.cam_label] = OdometryOptions::kBlindAfter_s;
	if (e.useImu()) longest_s_[options.rawlog.imu_label] = e.window.max_imu_gap_s;
	if (e.useWheels()) longest_s_[options.rawlog.odometry_label] = e.window.max_wheel_gap_s;
}

std::optional<GapLog::Gap> GapLog::add(const std::string& label, int64_t t_ns)
{
	const auto longest = longest_s_.find(label);
	if (longest == longest_s_.end()) return std::nullopt;
	const auto [last, is_first] = last_ns_.try_emplace(label, t_ns);
	const Gap gap{label, last->second, secondsBetween(last->second, t_ns)};
	last->second = t_ns;
	if (gap.duration_s <= longest->second) return std::nullopt;
	gaps_.push_back(gap);
	return gap;
}

void GapLog::finish(int64_t t_ns)
{
	const auto last_ns = last_ns_;
	for (const auto& [label, last] : last_ns) add(label, t_ns);
}

size_t GapLog::count(const std::string& label) const
{
	return static_cast<size_t>(std::count_if(gaps_.begin(), gaps_.end(), [&](const Gap& gap) { return gap.label == label; }));
}
}  // namespace viwo
