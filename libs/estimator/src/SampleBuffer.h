#pragma once

#include <viwo/core/ImuSample.h>
#include <viwo/core/WheelSample.h>

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "WheelPreintegration.h"

namespace viwo
{
/** IMU samples in order of time, cut at image times on request. Between samples a signal is linear. */
class ImuBuffer
{
   public:
	/** @return false, and the sample is not taken, where it is not later than the latest. */
	bool add(const ImuSample& sample);

	/** Whether t_ns lies between the first and the latest sample, ends included. */
	bool covers(int64_t t_ns) const;

	/** Samples over [t_begin_ns, t_end_ns], the first and the last exactly at its ends (interpolated where no sample is).
	 *  Nothing where the interval is empty, not covered, or two neighbouring samples in use are more than max_gap_s apart.
	 */
	std::optional<std::vector<ImuSample>> span(int64_t t_begin_ns, int64_t t_end_ns, double max_gap_s) const;

	/** Forgets what is not needed for t_ns and later: the latest sample at or before t_ns stays. */
	void dropBefore(int64_t t_ns);

	bool empty() const { return samples_.empty(); }
	/** Smallest int64_t when empty. */
	int64_t latest_ns() const;

   private:
	ImuSample at(int64_t t_ns) const;

	std::deque<ImuSample> samples_;
};

/** Wheel samples in order of time, cut at image times on request. Their speeds are means since the sample before. */
class WheelBuffer
{
   public:
	/** @return false, and the sample is not taken, where it is not later than the latest. */
	bool add(const WheelSample& sample);

	/** Whether t_ns lies between the first and the latest sample, ends included (the first only begins an interval). */
	bool covers(int64_t t_ns) const;

	/** The pieces of the samples' intervals that make up [t_begin_ns, t_end_ns], in order; conserves wheel travel.
	 *  Nothing where the interval is empty, not covered, or two neighbouring samples in use are more than max_gap_s apart.
	 */
	std::optional<std::vector<WheelSegment>> segments(int64_t t_begin_ns, int64_t t_end_ns, double max_gap_s) const;

	/** Forgets what is not needed for t_ns and later: the latest sample at or before t_ns stays. */
	void dropBefore(int64_t t_ns);

	bool empty() const { return samples_.empty(); }
	/** Smallest int64_t when empty. */
	int64_t latest_ns() const;

   private:
	std::deque<WheelSample> samples_;
};
}  // namespace viwo
