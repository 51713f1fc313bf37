#pragma once

#include "calibration/BatchProblem.h"

#include <vector>

namespace viwo
{
/** Minimises the sum of all factors over all blocks but `fixed` ones. One thread, capped iterations: repeatable.
 *  @return whether the result can be used. */
bool solveBatch(const std::vector<BatchFactor>& factors, const LandmarkMap& landmarks, const std::vector<const double*>& fixed,
                int max_iterations);
}  // namespace viwo
