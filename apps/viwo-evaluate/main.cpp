#include "Relations.h"

#include <viwo/app/Program.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/evaluation/PlotSvg.h>
#include <viwo/evaluation/Report.h>
#include <viwo/evaluation/Table.h>
#include <viwo/evaluation/TrajectoryPictures.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>

using namespace viwo;

namespace
{
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Arguments
{
	std::string reference;
	std::vector<std::string> estimates;
	std::string alignment = "se3";
	std::string json;
	std::string svg;
	std::string html;
	bool allow_missing = false;
	bool nees = false;
	std::vector<std::string> covariances;
	double max_ate_m = kNoLimit;
	double min_coverage = 0;
	EvaluationOptions options;
};

void declare(CLI::App& cli, Arguments& a)
{
	cli.add_option("-r,--reference", a.reference, "Reference trajectory (TUM)")->type_name("FILE.tum")->required();
	cli.add_option("-e,--estimate", a.estimates, "Estimated trajectory (TUM); may be given several times")
	    ->type_name("FILE.tum")
	    ->required();
	cli.add_option("--align", a.alignment, "What is taken out before comparing: se3, yaw (z rotation and shift), none or sim3 (with scale)")
	    ->check(CLI::IsMember({"se3", "yaw", "none", "sim3"}))
	    ->capture_default_str();
	cli.add_flag("--allow-missing", a.allow_missing,
	             "An estimate whose file is not there or empty is a row without figures (and over every limit)");
	cli.add_option("--json", a.json, "Write the figures to this file too")->type_name("FILE.json");
	cli.add_option("--svg", a.svg, "Draw reference and aligned estimates from above into this file")->type_name("FILE.svg");
	cli.add_option("--html", a.html, "Write figures and pictures as one page to this file: no script, no network, light and dark")
	    ->type_name("FILE.html");
	cli.add_flag("--nees", a.nees, "Compare errors with the covariances in trajectory_covariance.csv beside each estimate");
	cli.add_option("--covariance", a.covariances, "Covariance file for each estimate, in the same order (implies --nees)")
	    ->type_name("FILE.csv");
	cli.add_option("--max-ate", a.max_ate_m, "Exit with 1 when the x-y-z ATE of an estimate is above, m")->check(app::nonNegative());
	cli.add_option("--min-coverage", a.min_coverage, "Exit with 1 when the coverage of an estimate is below, 0 to 1")
	    ->check(app::between(0, 1));
	cli.add_option("--max-gap", a.options.max_gap_s, "Longest gap of the reference to interpolate across, s")
	    ->check(app::positive())
	    ->capture_default_str();
	cli.footer(
	    "Examples:\n"
	    "  viwo-evaluate -r truth.tum -e out/trajectory.tum\n"
	    "  viwo-evaluate -r truth.tum -e wheel/trajectory.tum -e viwo/trajectory.tum --json errors.json --svg paths.svg\n"
	    "  viwo-evaluate -r truth.tum -e a/trajectory.tum -e b/trajectory.tum --html report.html\n"
	    "  viwo-evaluate -r truth.tum -e out/trajectory.tum --max-ate 0.05 --min-coverage 0.97 --nees\n"
	    "  viwo-evaluate relations -r intel.relations -e intel/trajectory.tum --stamps intel_stamps.csv\n"
	    "Exit status: 0 done, 1 failed or over a limit, 2 bad usage.");
}

/** Of an estimate that is not there. */
TrajectoryErrors noErrors()
{
	constexpr double none = std::numeric_limits<double>::quiet_NaN();
	TrajectoryErrors e;
	e.length_m = e.estimate_length_m = none;
	e.ate_xy_m = e.ate_z_m = e.ate_xyz_m = e.ate_median_m = e.ate_max_m = none;
	e.yaw_rmse_deg = e.rotation_rmse_deg = none;
	e.rpe_interval_trans_m = e.rpe_interval_rot_deg = e.rpe_trans_percent = e.rpe_rot_deg_per_m = none;
	return e;
}

/** Not there, or empty as that of a run that found no pose. */
bool isMissing(const std::string& path)
{
	std::error_code ignored;
	return !std::filesystem::exists(path, ignored) || std::filesystem::is_empty(path, ignored);
}

EstimateReport evaluateFile(const Arguments& a, const Trajectory& reference, size_t index, std::vector<MatchedPose>& matches)
{
	EstimateReport report;
	report.name = a.estimates[index];
	if (a.allow_missing && isMissing(report.name))
	{
		report.errors = noErrors();
		return report;
	}
	const Trajectory estimate = Trajectory::loadTum(report.name);
	try
	{
		report.errors = evaluate(reference, estimate, a.options, &matches);
	}
	catch (const Error& e)
	{
		throw Error(report.name + " against " + a.reference + ": " + e.what());
	}
	if (a.nees)
	{
		const std::string csv = a.covariances.empty()
		                            ? std::filesystem::path(report.name).replace_filename("trajectory_covariance.csv").string()
		                            : a.covariances[index];
		report.consistency = consistency(reference, estimate, loadCovariances(csv), a.options.max_gap_s);
		if (report.consistency->pose.poses == 0) throw Error(csv + ": no usable covariance at the stamps of " + report.name);
	}
	return report;
}

std::string alignmentTitle(AlignmentKind kind)
{
	return kind == AlignmentKind::none ? "as they are" : std::string("aligned (") + toString(kind) + ")";
}

/** Estimates that are not there have a row in the table and no curve. */
void writeHtml(const Arguments& a, const Trajectory& reference, const std::vector<EstimateReport>& reports)
{
	std::vector<NamedTrajectory> estimates;
	const std::vector<std::string> names = legendNames(a.estimates);
	for (size_t i = 0; i < a.estimates.size(); ++i)
		if (!isMissing(a.estimates[i])) estimates.push_back({names[i], Trajectory::loadTum(a.estimates[i])});
	writeAtomically(
	    a.html, evaluationHtml(a.reference, a.options, reports, trajectoryPictures(reference, estimates, a.options, PlotColours::page)));
}

/** One line for each limit that is not kept. */
bool withinLimits(const Arguments& a, const std::vector<EstimateReport>& reports)
{
	bool within = true;
	for (const EstimateReport& r : reports)
	{
		if (!(r.errors.ate_xyz_m <= a.max_ate_m) && a.max_ate_m < kNoLimit)
		{
			std::fprintf(stderr, "viwo-evaluate: %s: ATE %.4f m is over the limit of %g m\n", r.name.c_str(), r.errors.ate_xyz_m,
			             a.max_ate_m);
			within = false;
		}
		if (r.errors.coverage < a.min_coverage)
		{
			std::fprintf(stderr, "viwo-evaluate: %s: coverage %.4f is under the limit of %g\n", r.name.c_str(), r.errors.coverage,
			             a.min_coverage);
			within = false;
		}
	}
	return within;
}

int evaluateAll(Arguments& a)
{
	a.options.alignment = alignmentFromString(a.alignment);
	if (!a.covariances.empty()) a.nees = true;
	if (!a.covariances.empty() && a.covariances.size() != a.estimates.size())
		throw app::UsageError(std::to_string(a.covariances.size()) + " covariance files for " + std::to_string(a.estimates.size()) +
		                      " estimates");

	const Trajectory reference = Trajectory::loadTum(a.reference);
	std::vector<EstimateReport> reports;
	std::vector<PlotCurve> curves{plotCurve("reference", reference)};
	const std::vector<std::string> names = legendNames(a.estimates);
	for (size_t i = 0; i < a.estimates.size(); ++i)
	{
		std::vector<MatchedPose> matches;
		reports.push_back(evaluateFile(a, reference, i, matches));
		if (!matches.empty()) curves.push_back(plotCurve(names[i] + " (ATE " + fixed(reports.back().errors.ate_xyz_m, 3) + " m)", matches));
	}

	std::cout << toTable(reports, a.options) << std::flush;
	if (!a.json.empty()) saveJson(a.json, toJson(a.reference, a.options, reports));
	if (!a.svg.empty()) saveSvg(a.svg, curves, "Trajectories from above, " + alignmentTitle(a.options.alignment));
	if (!a.html.empty()) writeHtml(a, reference, reports);
	return withinLimits(a, reports) ? 0 : 1;
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli{"Absolute and relative errors of estimated trajectories against a reference", "viwo-evaluate"};
	Arguments arguments;
	declare(cli, arguments);
	RelationArguments relation_arguments;
	CLI::App* relations = declareRelations(cli, relation_arguments);
	// The subcommand has files of its own.
	relations->preparse_callback([&cli](size_t) { cli.get_option("-r")->required(false), cli.get_option("-e")->required(false); });
	return app::run(cli, argc, argv, [&] { return relations->parsed() ? evaluateRelations(relation_arguments) : evaluateAll(arguments); });
}
