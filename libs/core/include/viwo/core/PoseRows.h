#pragma once

#include <viwo/core/TextRows.h>
#include <viwo/core/Trajectory.h>

#include <string>

namespace viwo
{
/** Appends the pose that a row holds. @throws Error naming the row when it is not later than the one before. */
void appendPose(const TextRows& rows, const StampedPose& pose, Trajectory& trajectory);

/** `x y z qx qy qz qw` as TUM's rows have them: m with 9 decimals, and a quaternion with 12. */
std::string poseRow(const Pose3& T);
}  // namespace viwo
