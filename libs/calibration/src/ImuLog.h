#pragma once

#include <viwo/calibration/ImuNoiseRun.h>

#include <optional>

#include "RestCheck.h"

namespace viwo
{
/** What the rawlogs hold of an IMU, and of wheels beside it. */
struct ImuLog
{
	ImuRecord record;
	int64_t start_ns = 0;  //!< the IMU's first stamp, whatever part is used
	Pose3 T_OB;
	std::vector<TimeSpan> driven;  //!< where wheels turn
	std::map<std::string, uint64_t> rejected;
	bool truncated = false;
};

/** @throws Error: no IMU under the label, no acceleration or no rates in it, interrupted. */
ImuLog readImuLog(const ImuNoiseOptions& options, const ImuNoiseHooks& hooks);
}  // namespace viwo
