#include "RelativeErrors.h"

#include <mrpt/core/format.h>
#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
std::string spanText(const Trajectory& trajectory)
{
	return mrpt::format("%.3f to %.3f s", static_cast<double>(trajectory.poses().front().t_ns) / kNanosecondsPerSecond,
	                    static_cast<double>(trajectory.poses().back().t_ns) / kNanosecondsPerSecond);
}

void requireMatches(const Trajectory& reference, const Trajectory& estimate, size_t matched, double max_gap_s)
{
	if (matched >= 2) return;
	if (reference.size() < 2) throw Error("the reference has fewer than two poses: nothing can be interpolated");
	if (estimate.size() < 2) throw Error("the estimate has fewer than two poses: nothing to compare");
	const auto& ref = reference.poses();
	const auto& est = estimate.poses();
	if (est.back().t_ns < ref.front().t_ns || est.front().t_ns > ref.back().t_ns)
		throw Error("no overlap in time: the reference spans " + spanText(reference) + ", the estimate " + spanText(estimate) +
		            "; check that both use the same clock");
	throw Error(
	    mrpt::format("only %zu pose(s) of the estimate can be matched, since the reference has gaps longer than %g s; allow longer ones",
	                 matched, max_gap_s));
}

void absoluteErrors(const std::vector<MatchedPose>& matches, TrajectoryErrors& errors)
{
	const double n = static_cast<double>(matches.size());
	double xy = 0, z = 0, yaw = 0, rotation = 0;
	std::vector<double> norms;
	for (const MatchedPose& m : matches)
	{
		const Eigen::Vector3d e = m.T_est.p - m.T_ref.p;
		xy += e.head<2>().squaredNorm() / n;
		z += e.z() * e.z() / n;
		norms.push_back(e.norm());
		yaw += std::pow(wrapAngle(yawOf(m.T_est.R) - yawOf(m.T_ref.R)), 2) / n;
		rotation += std::pow(m.T_ref.R.angularDistance(m.T_est.R), 2) / n;
	}
	errors.ate_xy_m = std::sqrt(xy);
	errors.ate_z_m = std::sqrt(z);
	errors.ate_xyz_m = std::sqrt(xy + z);
	errors.yaw_rmse_deg = std::sqrt(yaw) * 180 / M_PI;
	errors.rotation_rmse_deg = std::sqrt(rotation) * 180 / M_PI;
	std::sort(norms.begin(), norms.end());
	errors.ate_max_m = norms.back();
	errors.ate_median_m = 0.5 * (norms[(norms.size() - 1) / 2] + norms[norms.size() / 2]);
}
}  // namespace

double wrapAngle(double angle_rad)
{
	const double wrapped = std::remainder(angle_rad, 2 * M_PI);
	return wrapped <= -M_PI ? M_PI : wrapped;
}

std::vector<MatchedPose> matchPoses(const Trajectory& reference, const Trajectory& estimate, double max_gap_s)
{
	std::vector<MatchedPose> matches;
	for (const StampedPose& pose : estimate.poses())
		if (const auto T_ref = reference.at(pose.t_ns, max_gap_s)) matches.push_back({pose.t_ns, *T_ref, pose.T});
	return matches;
}

TrajectoryErrors evaluate(const Trajectory& reference, const Trajectory& estimate, const EvaluationOptions& options,
                          std::vector<MatchedPose>* matches_out)
{
	std::vector<MatchedPose> matches = matchPoses(reference, estimate, options.max_gap_s);
	requireMatches(reference, estimate, matches.size(), options.max_gap_s);

	std::vector<Pose3> refs, ests;
	std::vector<int64_t> stamps_ns;
	for (const MatchedPose& m : matches) refs.push_back(m.T_ref), ests.push_back(m.T_est), stamps_ns.push_back(m.t_ns);

	TrajectoryErrors errors;
	errors.matched = matches.size();
	errors.unmatched = estimate.size() - matches.size();
	errors.matched_duration_s = coveredDuration_s(stamps_ns, options.max_gap_s);
	errors.coverage = errors.matched_duration_s / secondsBetween(reference.poses().front().t_ns, reference.poses().back().t_ns);
	errors.alignment = align(options.alignment, refs, ests);
	for (MatchedPose& m : matches) m.T_est = errors.alignment * m.T_est;

	for (size_t i = 1; i < matches.size(); ++i)
	{
		errors.length_m += (matches[i].T_ref.p - matches[i - 1].T_ref.p).norm();
		errors.estimate_length_m += (matches[i].T_est.p - matches[i - 1].T_est.p).norm();
	}
	absoluteErrors(matches, errors);
	relativeErrors(matches, options, errors);
	if (matches_out != nullptr) *matches_out = std::move(matches);
	return errors;
}
}  // namespace viwo
