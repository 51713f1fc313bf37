#pragma once

#include <viwo/calibration/EvenImu.h>

#include <string>
#include <vector>

namespace viwo
{
/** A part of a log, s from its first stamp. */
struct TimeSpan
{
	double begin_s = 0, end_s = 0;
};

/** "12.0-14.0 s, 80.0 s and 3 more": the spans, those closer than 2 s as one. */
std::string describeSpans(const std::vector<TimeSpan>& spans);

struct RestCheck
{
	std::vector<std::string> warnings;
	double disturbed_share = 0;  //!< of the log: knocked or driven
};

/** Whether an IMU stood still: looks for knocks, steps, drifts, samples that repeat, and units that cannot be. What was knocked or driven
 * is taken out of `imu` (NaN). @param driven where the wheels turned. */
RestCheck checkRest(EvenImu& imu, const std::vector<TimeSpan>& driven);
}  // namespace viwo
