#pragma once

#include "Group.h"
#include "Measure.h"

namespace viwo::accuracy
{
/** One mode on one drive, with all seeds. */
std::vector<RunRecipe> runsOf(const SimulatedDrive& drive, int seeds, const std::string& mode = "viwo", const std::string& variant = "",
                              const std::vector<std::string>& overrides = {});

std::vector<Score> scoresOf(const Runner& runner, const std::vector<RunRecipe>& runs, double required_coverage = kRequiredCoverage);

void wantAll(Runner& runner, const std::vector<RunRecipe>& runs);

/** max over the seeds of a[i] - b[i]; where both are infinite, infinite. */
double worstExcess(const std::vector<double>& a, const std::vector<double>& b);
}  // namespace viwo::accuracy
