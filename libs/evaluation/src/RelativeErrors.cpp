#include "RelativeErrors.h"

#include <viwo/core/Time.h>

#include <cmath>
#include <limits>
#include <optional>

namespace viwo
{
namespace
{
struct RootMeanSquare
{
	double sum = 0;
	size_t count = 0;
	void add(double x) { sum += x * x, ++count; }
	double value() const { return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : std::numeric_limits<double>::quiet_NaN(); }
};

/** Sturm et al. Eq. 1: (Q_i^-1 Q_j)^-1 (P_i^-1 P_j). */
Pose3 relativeError(const MatchedPose& i, const Pose3& T_ref_j, const Pose3& T_est_j)
{
	const Pose3 T_ref = i.T_ref.inverse() * T_ref_j;
	const Pose3 T_est = i.T_est.inverse() * T_est_j;
	return T_ref.inverse() * T_est;
}

double angleOf_deg(const Pose3& T)
{
	return T.R.angularDistance(Eigen::Quaterniond::Identity()) * 180 / M_PI;
}

Pose3 interpolate(const Pose3& a, const Pose3& b, double s)
{
	return {a.R.slerp(s, b.R), (1 - s) * a.p + s * b.p};
}
}  // namespace

void relativeErrors(const std::vector<MatchedPose>& matches, const EvaluationOptions& options, TrajectoryErrors& errors)
{
	RootMeanSquare interval_trans, interval_rot, distance_trans, distance_rot;
	std::vector<double> path_m(matches.size(), 0.0);
	for (size_t i = 1; i < matches.size(); ++i) path_m[i] = path_m[i - 1] + (matches[i].T_ref.p - matches[i - 1].T_ref.p).norm();

	size_t by_time = 0, by_distance = 0;
	for (size_t i = 0; i < matches.size(); ++i)
	{
		const int64_t t_end_ns = matches[i].t_ns + nanoseconds(options.rpe_interval_s);
		while (by_time < matches.size() && matches[by_time].t_ns < t_end_ns) ++by_time;
		if (by_time < matches.size() && by_time > i)
		{
			// Exactly the interval asked for, whatever the rate of the estimate.
			const MatchedPose& before = matches[by_time - 1];
			const MatchedPose& after = matches[by_time];
			const double step_s = secondsBetween(before.t_ns, after.t_ns);
			if (step_s <= options.max_gap_s || after.t_ns == t_end_ns)
			{
				const double s = secondsBetween(before.t_ns, t_end_ns) / step_s;
				const Pose3 E =
				    relativeError(matches[i], interpolate(before.T_ref, after.T_ref, s), interpolate(before.T_est, after.T_est, s));
				interval_trans.add(E.p.norm());
				interval_rot.add(angleOf_deg(E));
			}
		}
		while (by_distance < matches.size() && path_m[by_distance] - path_m[i] < options.rpe_distance_m) ++by_distance;
		if (by_distance < matches.size())
		{
			const Pose3 E = relativeError(matches[i], matches[by_distance].T_ref, matches[by_distance].T_est);
			const double distance_m = path_m[by_distance] - path_m[i];
			distance_trans.add(100 * E.p.norm() / distance_m);
			distance_rot.add(angleOf_deg(E) / distance_m);
		}
	}
	errors.rpe_interval_trans_m = interval_trans.value();
	errors.rpe_interval_rot_deg = interval_rot.value();
	errors.rpe_interval_pairs = interval_trans.count;
	errors.rpe_trans_percent = distance_trans.value();
	errors.rpe_rot_deg_per_m = distance_rot.value();
	errors.rpe_distance_pairs = distance_trans.count;
}
}  // namespace viwo
