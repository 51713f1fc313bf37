#pragma once

#include "KeyScans.h"

namespace viwo::gt
{
/** Final pose of one scan. */
struct FinalPose
{
	Pose2 T;
	PoseFlag flag = PoseFlag::odometry_only;
	Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  //!< (x, y, yaw) relative to the first pose
	std::optional<Pose2> matched;                          //!< pose by registration to the finished map alone, where that is good
};

/** Every scan on the finished map: registered with the key scans around it, and smoothed over time together with odometry; key scans stay
 * where the graph has put them.
 *  @param holdout scans whose registration is only recorded, not used.
 */
std::vector<FinalPose> placeAllScans(const Session& session, const FrontEndResult& front_end, const KeyScans& keys,
                                     const std::vector<Eigen::Matrix3d>& key_covariances, const MotionModel& motion,
                                     const GroundTruthOptions& options, const Scales& scales, const std::function<bool(size_t)>& holdout,
                                     int threads, const std::function<bool(double)>& proceed);
}  // namespace viwo::gt
