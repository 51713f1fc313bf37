#pragma once

#include "GapLog.h"
#include "MinuteLog.h"
#include "RunOutputs.h"

#include <viwo/odometry/OdometryRun.h>

#include <string>

namespace viwo
{
/** Writes summary.json: how the run went, in numbers with their units in the names. @throws Error when it cannot be written. */
void writeSummary(const std::string& path, const OdometryRunOptions& options, const OdometryRunResult& result, const Odometry& odometry,
                  const RunOutputs& outputs, const RawlogCounts& counts, const MinuteLog& minutes, const GapLog& gaps);
}  // namespace viwo
