#include "RestWindows.h"

#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>

#include "Median.h"

namespace viwo
{
namespace
{
constexpr size_t kLeastSamples = 20;
constexpr double kLeastExcess = 1.5;  // of a second's deviation over the usual one
}  // namespace

RestWindows::RestWindows(const EvenImu& imu) : imu_(imu)
{
	const size_t length = std::max(kLeastSamples, static_cast<size_t>(std::lround(1 / imu.interval_s)));
	for (size_t p = 0; p < imu.pieces.size(); ++p)
		for (size_t begin = 0; begin < imu.pieces[p].cells; begin += length)
			places_.push_back({p, begin, std::min(begin + length, imu.pieces[p].cells)});
	for (size_t axis = 0; axis < kImuAxes; ++axis)
	{
		std::vector<double> deviations;
		for (const Place& place : places_)
		{
			axes_[axis].push_back(statisticsOf(imu.axes[axis][place.piece], place));
			if (axes_[axis].back().count > 1) deviations.push_back(axes_[axis].back().deviation);
		}
		typical_[axis] = medianOf(deviations);
	}
}

RestWindows::Statistics RestWindows::statisticsOf(const std::vector<double>& piece, const Place& place)
{
	Statistics s;
	for (size_t i = place.begin; i < place.end; ++i)
		if (std::isfinite(piece[i])) s.mean += piece[i], ++s.count;
	if (s.count == 0) return s;
	s.mean /= static_cast<double>(s.count);
	double squares = 0;
	for (size_t i = place.begin; i < place.end; ++i)
	{
		if (!std::isfinite(piece[i])) continue;
		const double offset = std::abs(piece[i] - s.mean);
		squares += offset * offset;
		s.farthest = std::max(s.farthest, offset);
	}
	s.deviation = std::sqrt(squares / static_cast<double>(s.count));
	return s;
}

TimeSpan RestWindows::span(size_t window) const
{
	const Place& place = places_[window];
	const int64_t start_ns = imu_.log_start_ns;
	return {secondsBetween(start_ns, imu_.t_ns(place.piece, place.begin)), secondsBetween(start_ns, imu_.t_ns(place.piece, place.end))};
}

bool RestWindows::knocked(size_t window, double limit) const
{
	for (size_t axis = 0; axis < kImuAxes; ++axis)
	{
		const Statistics& s = axes_[axis][window];
		if (s.count < 2 || typical_[axis] <= 0) continue;
		const double spread = 1 / std::sqrt(2 * static_cast<double>(s.count));
		if (s.deviation > typical_[axis] * std::max(kLeastExcess, 1 + limit * spread) || s.farthest > limit * typical_[axis]) return true;
	}
	return false;
}

double RestWindows::medianMean(size_t axis) const
{
	std::vector<double> means;
	for (const Statistics& s : axes_[axis])
		if (s.count > 0) means.push_back(s.mean);
	return medianOf(means);
}

std::vector<RestWindows::Block> RestWindows::blocks(size_t axis, size_t windows) const
{
	std::vector<Block> blocks;
	for (size_t begin = 0; begin + windows <= size(); begin += windows)
	{
		std::vector<double> means;
		for (size_t w = begin; w < begin + windows; ++w)
			if (axes_[axis][w].count > 0) means.push_back(axes_[axis][w].mean);
		if (!means.empty()) blocks.push_back({span(begin).begin_s, medianOf(means)});
	}
	return blocks;
}
}  // namespace viwo
