#pragma once

#include <viwo/calibration/EvenImu.h>

#include <array>
#include <cstddef>
#include <vector>

#include "RestCheck.h"

namespace viwo
{
/** Mean, deviation and range of each second of an IMU's samples. */
class RestWindows
{
   public:
	struct Place
	{
		size_t piece, begin, end;  //!< cells
	};
	struct Block
	{
		double begin_s, value;  //!< s from the log's start; median of its windows' means
	};

	explicit RestWindows(const EvenImu& imu);

	size_t size() const { return places_.size(); }
	const Place& place(size_t window) const { return places_[window]; }
	TimeSpan span(size_t window) const;

	/** Some axis is far noisier there than it mostly is. @param limit in deviations. */
	bool knocked(size_t window, double limit) const;
	double medianMean(size_t axis) const;
	/** Windows that follow one another, those without samples left out. */
	std::vector<Block> blocks(size_t axis, size_t windows) const;

   private:
	struct Statistics
	{
		size_t count = 0;
		double mean = 0, deviation = 0, farthest = 0;  //!< farthest sample from the mean
	};
	static Statistics statisticsOf(const std::vector<double>& piece, const Place& place);

	const EvenImu& imu_;
	std::vector<Place> places_;
	std::array<std::vector<Statistics>, kImuAxes> axes_;
	std::array<double, kImuAxes> typical_{};  //!< median of the deviations
};
}  // namespace viwo
