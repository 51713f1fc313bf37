#pragma once

#include <viwo/odometry/Odometry.h>
#include <viwo/odometry/OdometryOptions.h>

#include <nlohmann/json.hpp>

namespace viwo
{
/** Entry "calibration" of summary.json: what was estimated, each with its deviation, and what was not, as it was given. */
nlohmann::ordered_json calibrationJson(const Odometry& odometry, const OdometryOptions& options);
}  // namespace viwo
