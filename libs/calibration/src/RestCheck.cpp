#include "RestCheck.h"

#include <viwo/core/NumberText.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "Median.h"
#include "RestWindows.h"

namespace viwo
{
namespace
{
constexpr double kMargin_s = 1;      // that a robot goes on shaking after its wheels have stopped
constexpr double kKnock = 8;         // deviations of a sample, or of a second's deviation
constexpr double kStep = 8;          // deviations of the other differences of neighbouring 20 s
constexpr size_t kBlock = 5;         // windows
constexpr size_t kSide = 4;          // blocks on each side of a step
constexpr double kTrendShare = 0.9;  // of the variance of the means
constexpr double kRepeatedShare = 0.3;
constexpr double kFastestRest_rad_s = 0.1;

/** Sample-wise, of one axis. */
class AxisCheck
{
   public:
	AxisCheck(const EvenImu& imu, size_t axis, const RestWindows& windows)
	    : imu_(imu), axis_(axis), name_(imuAxisName(axis)), unit_(imuAxisUnit(axis)), windows_(windows)
	{
	}

	/** A step lasts: 20 s before and after it differ far more than elsewhere. */
	void findSteps(std::vector<std::string>& warnings) const
	{
		const std::vector<RestWindows::Block> blocks = windows_.blocks(axis_, kBlock);
		std::vector<double> differences;
		for (size_t i = kSide; i + kSide <= blocks.size(); ++i)
		{
			double difference = 0;
			for (size_t k = 0; k < kSide; ++k) difference += (blocks[i + k].value - blocks[i - 1 - k].value) / kSide;
			differences.push_back(difference);
		}
		if (differences.size() < 3 * kSide) return;
		const double middle = medianOf(differences);
		std::vector<double> offsets;
		for (const double d : differences) offsets.push_back(std::abs(d - middle));
		const double limit = kStep * 1.4826 * medianOf(offsets);
		std::vector<TimeSpan> steps;
		double largest = 0;
		for (size_t i = 0; i < offsets.size(); ++i)
		{
			const size_t begin = i - std::min(i, kSide), end = std::min(i + kSide + 1, offsets.size());
			if (offsets[i] <= limit || offsets[i] < *std::max_element(offsets.begin() + static_cast<std::ptrdiff_t>(begin),
			                                                          offsets.begin() + static_cast<std::ptrdiff_t>(end)))
				continue;
			steps.push_back({blocks[i + kSide].begin_s, blocks[i + kSide].begin_s});
			largest = std::max(largest, offsets[i]);
		}
		if (!steps.empty())
			warnings.push_back(name_ + " steps by " + significant(largest, 3) + " " + unit_ + " at " + describeSpans(steps) +
			                   ": moved, or another temperature; choose a part without with --from and --to");
	}

	/** Most of what the means do is a straight line. */
	void findTrend(std::vector<std::string>& warnings) const
	{
		const std::vector<RestWindows::Block> blocks = windows_.blocks(axis_, std::max<size_t>(1, windows_.size() / 20));
		if (blocks.size() < 10) return;
		double t = 0, x = 0, tt = 0, tx = 0, xx = 0;
		const double n = static_cast<double>(blocks.size());
		for (const auto& b : blocks) t += b.begin_s / n, x += b.value / n;
		for (const auto& b : blocks)
			tt += (b.begin_s - t) * (b.begin_s - t), tx += (b.begin_s - t) * (b.value - x), xx += (b.value - x) * (b.value - x);
		if (!(tx * tx > kTrendShare * tt * xx)) return;
		const double change = tx / tt * (blocks.back().begin_s - blocks.front().begin_s);
		warnings.push_back(name_ + " drifts by " + significant(change, 3) + " " + unit_ +
		                   " along the log: a sensor that warms up looks like this; let it reach its temperature before recording");
	}

	/** Samples published more often than measured, or steps of the resolution that hide the noise. */
	void findRepeats(std::vector<std::string>& warnings) const
	{
		size_t repeated = 0, all = 0;
		for (const auto& piece : imu_.axes[axis_])
			for (size_t i = 1; i < piece.size(); ++i)
				if (std::isfinite(piece[i]) && std::isfinite(piece[i - 1])) repeated += piece[i] == piece[i - 1] ? 1 : 0, ++all;
		const double share = all > 0 ? static_cast<double>(repeated) / static_cast<double>(all) : 0;
		if (share > kRepeatedShare)
			warnings.push_back(
			    name_ + ": " + fixed(100 * share, 0) +
			    " % of the samples repeat the one before: published faster than measured, or of a resolution that hides the noise");
	}

   private:
	const EvenImu& imu_;
	size_t axis_;
	std::string name_, unit_;
	const RestWindows& windows_;
};

void takeOut(EvenImu& imu, const RestWindows& windows, const std::vector<bool>& out)
{
	for (auto& axis : imu.axes)
		for (size_t w = 0; w < out.size(); ++w)
		{
			if (!out[w]) continue;
			const RestWindows::Place& place = windows.place(w);
			auto& piece = axis[place.piece];
			std::fill(piece.begin() + static_cast<std::ptrdiff_t>(place.begin), piece.begin() + static_cast<std::ptrdiff_t>(place.end),
			          std::numeric_limits<double>::quiet_NaN());
		}
}

void checkUnits(const RestWindows& windows, std::vector<std::string>& warnings)
{
	const auto size = [&](size_t first)
	{
		double sum = 0;
		for (size_t axis = first; axis < first + 3; ++axis) sum += std::pow(windows.medianMean(axis), 2);
		return std::sqrt(sum);
	};
	const double force = size(0), rate = size(3);
	if (force < 9 || force > 10.6)
		warnings.push_back("the specific force is " + significant(force, 3) +
		                   " m/s^2, that of gravity is 9.8: another unit, or not a three-axis accelerometer");
	if (rate > kFastestRest_rad_s) warnings.push_back("the mean rate is " + significant(rate, 3) + " rad/s: it turns, or another unit");
}
}  // namespace

std::string describeSpans(const std::vector<TimeSpan>& spans)
{
	constexpr double kClose_s = 2;
	constexpr size_t kMost = 5;
	std::vector<TimeSpan> joined;
	for (const TimeSpan& s : spans)
		if (!joined.empty() && s.begin_s <= joined.back().end_s + kClose_s)
			joined.back().end_s = std::max(joined.back().end_s, s.end_s);
		else
			joined.push_back(s);
	std::string text;
	for (size_t i = 0; i < std::min(kMost, joined.size()); ++i)
	{
		text += (i > 0 ? ", " : "") + fixed(joined[i].begin_s, 1);
		if (joined[i].end_s > joined[i].begin_s) text += "-" + fixed(joined[i].end_s, 1);
		text += " s";
	}
	if (joined.size() > kMost) text += " and " + std::to_string(joined.size() - kMost) + " more";
	return text;
}

RestCheck checkRest(EvenImu& imu, const std::vector<TimeSpan>& driven)
{
	RestCheck check;
	const RestWindows all(imu);
	std::vector<bool> out(all.size(), false);
	std::vector<TimeSpan> knocks;
	size_t disturbed = 0;
	for (size_t w = 0; w < all.size(); ++w)
	{
		const TimeSpan span = all.span(w);
		for (const TimeSpan& d : driven)
			if (d.begin_s <= span.end_s && d.end_s + kMargin_s >= span.begin_s) out[w] = true;
		if (!out[w] && all.knocked(w, kKnock))
		{
			out[w] = true;
			knocks.push_back(span);
		}
		disturbed += out[w] ? 1 : 0;
	}
	check.disturbed_share = all.size() > 0 ? static_cast<double>(disturbed) / static_cast<double>(all.size()) : 0;
	takeOut(imu, all, out);
	if (!driven.empty()) check.warnings.push_back("the wheels turn at " + describeSpans(driven) + ": left out");
	if (!knocks.empty()) check.warnings.push_back("knocked or moved at " + describeSpans(knocks) + ": left out");
	const RestWindows rest(imu);
	checkUnits(rest, check.warnings);
	for (size_t axis = 0; axis < kImuAxes; ++axis)
	{
		const AxisCheck one(imu, axis, rest);
		one.findRepeats(check.warnings);
		one.findSteps(check.warnings);
		one.findTrend(check.warnings);
	}
	return check;
}
}  // namespace viwo
