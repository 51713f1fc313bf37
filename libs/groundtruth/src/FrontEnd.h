#pragma once

#include "CorrelativeMatcher.h"
#include "MotionModel.h"
#include "Registration.h"

#include <functional>
#include <memory>

namespace viwo::gt
{
enum class PoseFlag
{
	good,
	degenerate,    //!< the scan leaves a direction open, which odometry or neighbours hold
	odometry_only  //!< the scan was of no use
};
const char* nameOf(PoseFlag flag);
/** Of a scan that lies on its map. @param trust in the weakest direction, 0 to 1. */
PoseFlag flagOf(double trust);

/** Lengths that grow with the noise of the ranges. */
struct Scales
{
	explicit Scales(double noise_m);
	double voxel_m;  //!< of local maps
	RegistrationOptions registration;
	double field_sigma_m, field_resolution_m;  //!< of correlative search
	double partners;                           //!< factor on how many key scans a key scan is registered with, and how far away
};

/** A scan as the front-end left it. */
struct TrackedScan
{
	Pose2 T;                                                //!< O in the front-end's drifting frame
	Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  //!< of the registration, in that frame's axes
	PoseFlag flag = PoseFlag::odometry_only;
	double trust = 0;  //!< in the weakest direction of the registration, 0 to 1
	double inlier_ratio = 0;
};

struct FrontEndResult
{
	std::vector<TrackedScan> scans;
	std::vector<size_t> keys;  //!< indices of key scans, increasing
	std::vector<Cloud> key_clouds;
	size_t searches = 0;               //!< scans whose guess was so poor that a window was searched
	std::vector<size_t> contradicted;  //!< scans found where odometry does not lead to from the scan before, increasing
};

/** Each scan against the local map of the last key scans, from the guess of odometry.
 *  @param may_be_key tells scans that may enter the map.
 */
FrontEndResult trackScans(const Session& session, const MotionModel& motion, const GroundTruthOptions& options, const Scales& scales,
                          const std::function<bool(size_t)>& may_be_key, const std::function<bool(double)>& proceed);
}  // namespace viwo::gt
