#include "StreamStatistics.h"

#include <viwo/core/Ranking.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
double quantile(std::vector<double> values, double share)
{
	return valueAtRank(values, static_cast<size_t>(share * static_cast<double>(values.size())));
}

void summarise(StreamInfo& info, std::vector<int64_t> stamps_ns)
{
	info.count = stamps_ns.size();
	for (size_t i = 1; i < stamps_ns.size(); ++i) info.backwards += stamps_ns[i] < stamps_ns[i - 1];
	std::sort(stamps_ns.begin(), stamps_ns.end());
	info.first_t_ns = stamps_ns.front(), info.last_t_ns = stamps_ns.back();
	if (stamps_ns.size() < 2) return;
	std::vector<double> intervals_s;
	for (size_t i = 1; i < stamps_ns.size(); ++i) intervals_s.push_back(secondsBetween(stamps_ns[i - 1], stamps_ns[i]));
	const double usual_s = quantile(intervals_s, 0.5), span_s = secondsBetween(info.first_t_ns, info.last_t_ns);
	info.rate_hz = span_s > 0 ? static_cast<double>(intervals_s.size()) / span_s : 0;
	info.largest_gap_s = *std::max_element(intervals_s.begin(), intervals_s.end());
	for (double& interval_s : intervals_s) interval_s = std::abs(interval_s - usual_s);
	info.jitter_s = quantile(intervals_s, 0.9);
}
}  // namespace

StreamInfo& StreamStatistics::add(const std::string& name, const std::string& type, SensorRole role, int64_t t_ns)
{
	Stream& stream = streams_[{name, type}];
	stream.info.name = name, stream.info.type = type, stream.info.role = role;
	stream.stamps_ns.push_back(t_ns);
	return stream.info;
}

std::vector<StreamInfo> StreamStatistics::finish()
{
	std::vector<StreamInfo> infos;
	for (auto& [key, stream] : streams_)
	{
		summarise(stream.info, std::move(stream.stamps_ns));
		infos.push_back(stream.info);
	}
	return infos;
}
}  // namespace viwo
