#pragma once

#include "Pipeline.h"

#include <string>

namespace viwo::gt
{
/** The same solution made without odometry edges, against the one that is written. */
struct WithoutOdometry
{
	double mean_m = 0, max_m = 0, mean_deg = 0;
};

void writeSummary(const std::string& path, const GroundTruthRunOptions& options, const Session& session, const Solution& solution,
                  const std::optional<WithoutOdometry>& without, const GroundTruthRunResult& result);
}  // namespace viwo::gt
