#pragma once

#include <viwo/evaluation/TrajectoryErrors.h>

#include <vector>

namespace viwo
{
/** Fills the rpe_* fields from aligned matches. */
void relativeErrors(const std::vector<MatchedPose>& matches, const EvaluationOptions& options, TrajectoryErrors& errors);
}  // namespace viwo
