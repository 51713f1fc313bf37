#pragma once

#include <viwo/core/TextRows.h>
#include <viwo/core/Trajectory.h>

namespace viwo
{
/** Appends the pose that a row holds. @throws Error naming the row when it is not later than the one before. */
void appendPose(const TextRows& rows, const StampedPose& pose, Trajectory& trajectory);
}  // namespace viwo
