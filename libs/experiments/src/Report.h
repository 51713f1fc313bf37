#pragma once

#include <viwo/experiments/Accuracy.h>
#include <viwo/experiments/Starts.h>

#include <string>

#include "Provenance.h"

namespace viwo::experiments
{
/** All tables and figures in one page. Pictures of trajectories are those of the first seed. */
std::string reportHtml(const Request& request, const Provenance& provenance, const std::vector<DriveResult>& drives,
                       const std::vector<Start>& starts);
}  // namespace viwo::experiments
