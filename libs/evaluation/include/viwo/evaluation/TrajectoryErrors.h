#pragma once

#include <viwo/core/Trajectory.h>
#include <viwo/evaluation/Alignment.h>

#include <cstdint>
#include <string>
#include <vector>

namespace viwo
{
/** How a trajectory is compared with its reference. */
struct EvaluationOptions
{
	AlignmentKind alignment = AlignmentKind::se3;
	double max_gap_s = 0.5;  //!< the reference is not interpolated across a longer gap
	double rpe_interval_s = 1;
	double rpe_distance_m = 1;
};

/** An estimate's pose beside the reference's at the same time. */
struct MatchedPose
{
	int64_t t_ns = 0;
	Pose3 T_ref;
	Pose3 T_est;  //!< aligned
};

/** Errors of a trajectory after Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012. All are root mean squares
 *  unless named otherwise; NaN where a figure does not exist (e.g. no two poses a metre apart).
 */
struct TrajectoryErrors
{
	size_t matched = 0;  //!< poses of the estimate that have a reference
	size_t unmatched = 0;
	double matched_duration_s = 0;  //!< sum of the intervals between matched poses, gaps of the estimate left out
	double coverage = 0;            //!< matched duration over the reference's
	double length_m = 0;            //!< of the reference, between the first and the last match
	double estimate_length_m = 0;
	Similarity alignment;

	double ate_xy_m = 0, ate_z_m = 0, ate_xyz_m = 0;
	double ate_median_m = 0, ate_max_m = 0;  //!< of x-y-z
	double yaw_rmse_deg = 0;
	double rotation_rmse_deg = 0;  //!< full angle, tilt included

	double rpe_interval_trans_m = 0, rpe_interval_rot_deg = 0;  //!< over options.rpe_interval_s
	double rpe_trans_percent = 0, rpe_rot_deg_per_m = 0;        //!< over options.rpe_distance_m of reference path, per distance
	size_t rpe_interval_pairs = 0, rpe_distance_pairs = 0;
};

/** The estimate's poses for which the reference can be interpolated, as they are (not aligned). */
std::vector<MatchedPose> matchPoses(const Trajectory& reference, const Trajectory& estimate, double max_gap_s);

/** @throws Error when fewer than two poses match: it says whether the time spans overlap.
 *  @param matches if given, receives the aligned poses.
 */
TrajectoryErrors evaluate(const Trajectory& reference, const Trajectory& estimate, const EvaluationOptions& options,
                          std::vector<MatchedPose>* matches = nullptr);

/** Difference of two angles, in (-pi, pi]. */
double wrapAngle(double angle_rad);
}  // namespace viwo
