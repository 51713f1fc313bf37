#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/evaluation/Chart.h>
#include <viwo/evaluation/Html.h>
#include <viwo/evaluation/TrajectoryPictures.h>

#include <algorithm>
#include <limits>

namespace viwo
{
namespace
{
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/** Error curves show at most this many points. */
constexpr size_t kPoints = 800;
constexpr int kAteDecimals = 4;
/** Of the reference, for the smallest error to stand out. */
constexpr double kComparableCoverage = 0.9;

LineChart::Curve errorCurve(const std::string& name, const std::vector<MatchedPose>& matches, int64_t begin_ns, double max_gap_s)
{
	LineChart::Curve curve{name, {}};
	const size_t step = 1 + matches.size() / kPoints;
	for (size_t i = 0; i < matches.size(); i += step)
	{
		const double t_s = secondsBetween(begin_ns, matches[i].t_ns);
		if (i >= step && secondsBetween(matches[i - step].t_ns, matches[i].t_ns) > max_gap_s + static_cast<double>(step))
			curve.points.emplace_back(t_s, kNone);
		curve.points.emplace_back(t_s, (matches[i].T_est.p - matches[i].T_ref.p).norm());
	}
	return curve;
}

LineChart::Curve driftCurve(const NamedTrajectory& estimate, const Trajectory& reference, EvaluationOptions options)
{
	LineChart::Curve curve{estimate.name, {}};
	const double length_m = reference.length_m();
	for (const double distance_m : {0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0, 200.0, 500.0})
	{
		if (distance_m > 0.7 * length_m) break;
		options.rpe_distance_m = distance_m;
		const TrajectoryErrors errors = evaluate(reference, estimate.trajectory, options);
		if (errors.rpe_distance_pairs > 0) curve.points.emplace_back(distance_m, errors.rpe_trans_percent);
	}
	return curve;
}

std::string alignmentText(AlignmentKind kind)
{
	switch (kind)
	{
		case AlignmentKind::se3:
			return "aligned by rotation and translation (se3)";
		case AlignmentKind::yaw:
			return "aligned by yaw and translation";
		case AlignmentKind::sim3:
			return "aligned by rotation, translation and scale (sim3)";
		case AlignmentKind::none:
			break;
	}
	return "not aligned";
}

/** A piece of the way is not better than the whole. */
bool comparable(const TrajectoryErrors& e)
{
	return e.coverage >= kComparableCoverage;
}

/** As it is printed. */
std::string smallestAte(const std::vector<EstimateReport>& reports)
{
	double best = std::numeric_limits<double>::infinity();
	for (const EstimateReport& r : reports)
		if (comparable(r.errors)) best = std::min(best, r.errors.ate_xyz_m);
	return fixed(best, kAteDecimals);
}

Table errorTable(const std::vector<EstimateReport>& reports)
{
	Table table({{"estimate", "", true},
	             {"length", "m"},
	             {"coverage", "%"},
	             {"ATE x-y", "m"},
	             {"ATE z", "m"},
	             {"ATE x-y-z", "m"},
	             {"of length", "%"},
	             {"yaw RMSE", "deg"},
	             {"RPE, 1\u00a0s", "m"},
	             {"RPE, 1\u00a0m", "%"}});
	const std::string best = smallestAte(reports);
	for (const EstimateReport& r : reports)
	{
		const TrajectoryErrors& e = r.errors;
		const bool bold = reports.size() > 1 && comparable(e) && fixed(e.ate_xyz_m, kAteDecimals) == best;
		table.addRow({r.name, fixed(e.length_m, 2), fixed(100 * e.coverage, 1), fixed(e.ate_xy_m, kAteDecimals),
		              fixed(e.ate_z_m, kAteDecimals), fixed(e.ate_xyz_m, kAteDecimals), fixed(100 * e.ate_xyz_m / e.length_m, 2),
		              fixed(e.yaw_rmse_deg, 3), fixed(e.rpe_interval_trans_m, 4), fixed(e.rpe_trans_percent, 2)},
		             bold ? std::set<size_t>{5} : std::set<size_t>{});
	}
	return table;
}
}  // namespace

TrajectoryPictures trajectoryPictures(const Trajectory& reference, const std::vector<NamedTrajectory>& estimates,
                                      const EvaluationOptions& options, PlotColours colours)
{
	std::vector<PlotCurve> paths{plotCurve("reference", reference)};
	LineChart errors{"Error over time", "time (s)", "distance from the reference (m)", {}};
	LineChart drift{"Drift over distance", "length of the piece (m)", "error of the piece (% of its length)", {}};
	for (const NamedTrajectory& estimate : estimates)
	{
		std::vector<MatchedPose> matches;
		const TrajectoryErrors e = evaluate(reference, estimate.trajectory, options, &matches);
		paths.push_back(plotCurve(estimate.name + " (ATE " + fixed(e.ate_xyz_m, 3) + " m)", matches));
		errors.curves.push_back(errorCurve(estimate.name, matches, reference.poses().front().t_ns, options.max_gap_s));
		drift.curves.push_back(driftCurve(estimate, reference, options));
	}
	return {toSvg(paths, "Trajectories from above", colours), toSvg(errors, colours), toSvg(drift, colours)};
}

std::string evaluationHtml(const std::string& reference, const EvaluationOptions& options, const std::vector<EstimateReport>& reports,
                           const TrajectoryPictures& pictures)
{
	HtmlPage page("Errors of trajectories");
	page.paragraph("Reference: " + reference + "; estimates " + alignmentText(options.alignment) + ".");
	page.table(errorTable(reports),
	           "Root mean squares. ATE: absolute trajectory error; RPE: relative error over 1 s and over 1 m of the path. The smallest ATE "
	           "of those that cover at least 90 % of the reference is bold.");
	page.beginRow();
	page.figure(pictures.paths, "Trajectories from above, " + alignmentText(options.alignment) + ", equal axes in metres.", true);
	page.figure(pictures.error_over_time, "Distance between each pose and the reference, in metres, over time in seconds.");
	page.figure(pictures.drift_over_distance, "Root mean square of the relative error of pieces of the path, in per cent of their length.");
	page.endRow();
	return page.toString();
}
}  // namespace viwo
