#include "Report.h"

#include <viwo/core/Error.h>
#include <viwo/evaluation/Chart.h>
#include <viwo/evaluation/Html.h>
#include <viwo/evaluation/TrajectoryPictures.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "TextFiles.h"

namespace viwo::experiments
{
namespace
{
std::string seedsText(const std::vector<uint64_t>& seeds)
{
	std::string text;
	for (const uint64_t seed : seeds) text += (text.empty() ? "" : ", ") + std::to_string(seed);
	return (seeds.size() == 1 ? "seed " : "seeds ") + text;
}

void introduce(HtmlPage& page, const Request& request, const Provenance& provenance)
{
	page.paragraph(
	    "The experiments of Niu et al. (Sec. 7) on simulated replicas of their six sequences, against the exact truth of the simulation. "
	    "The replicas have the lengths, motions and kinds of places of "
	    "the paper's sequences, not its recordings: figures of the paper stand beside ours as a measure of size, not as a comparison on "
	    "the same data.");
	page.paragraph("viwo " + provenance.version + " (build " + provenance.build + "), " + provenance.date + ", " +
	               seedsText(request.seeds) +
	               ". One configuration of the estimator, one robot and one set of sensor errors for all sequences. Figures are medians "
	               "over the seeds; alignment by rotation and translation.");
	if (request.tables.count(1) != 0 && !provenance.has_truth)
		page.paragraph(
		    "viwo-groundtruth was not there: this page is without Table 1 against the ground truth from LiDAR, and without Figure 5.");
	if (!provenance.interruption.empty()) page.paragraph(provenance.interruption);
}

/** Only modes: ablations have a table of their own. */
bool isMode(const DriveResult& result)
{
	return result.variant.overrides.empty();
}

void addTable1(HtmlPage& page, const std::vector<DriveResult>& drives)
{
	page.heading("Table 1: accuracy of whole drives");
	page.table(table1(drives),
	           "RMSE of the absolute trajectory error in metres; the best of our three modes is bold. The paper's vio is VINS-Mono. A "
	           "drive along one line leaves the roll about it to the alignment: there, errors of wheels alone in x-y may appear as z. Last "
	           "column: z of "
	           "viwo where yaw and translation alone are aligned, so that a tilt remains an error.");
	BarChart chart{"ATE x-y-z", "RMSE (m)", {}, {{"vio", {}}, {"wheel", {}}, {"viwo", {}}, {"paper's system", {}}}, 2};
	for (const DriveResult& result : drives)
	{
		if (!isMode(result)) continue;
		const double ate_m = result.median([](const DriveErrors& e) { return e.se3.ate_xyz_m; });
		for (size_t i = 0; i < modes().size(); ++i)
			if (modes()[i].name == result.variant.name)
				chart.series[i].values.push_back(std::isfinite(ate_m) ? ate_m : std::numeric_limits<double>::quiet_NaN());
		if (result.variant.name != "viwo") continue;
		chart.groups.push_back(result.sequence);
		chart.series[3].values.push_back(paperSequence(result.sequence).viwo.xyz_m);
	}
	page.figure(toSvg(chart, PlotColours::page), "RMSE of the ATE x-y-z in metres, by sequence.");
}

/** What the paper's way of judging says. */
void addLidar(HtmlPage& page, const std::vector<LidarDrive>& lidar)
{
	page.heading("Table 1 against the ground truth from LiDAR");
	page.table(table1Lidar(lidar),
	           "RMSE of the absolute trajectory error in the plane in metres, as in the paper against a trajectory made from the scans "
	           "(viwo-groundtruth); that trajectory's own error against the exact truth stands beside it.");
}

void addFigure5(HtmlPage& page, const Request& request, const std::vector<LidarDrive>& lidar)
{
	page.heading("Figure 5: grid maps");
	page.paragraph("Seed " + std::to_string(request.seeds.front()) +
	               ". Black: occupied, white: free, grey: not seen; the way is green where the scans hold it, orange where a direction is "
	               "left to odometry.");
	page.beginRow();
	for (const LidarDrive& drive : lidar)
		if (drive.seed == request.seeds.front() && std::filesystem::exists(drive.folder + "/map.png") && drive.problem.empty())
			page.image(readFile(drive.folder + "/map.png"), "image/png",
			           drive.sequence + ": grid map from LiDAR, cells of 5 cm, scale in metres.");
	page.endRow();
}

/** Figure 6 of the paper for one sequence: the modes of the first seed over the truth. */
void addTrajectories(HtmlPage& page, const std::string& sequence, const std::vector<DriveResult>& drives)
{
	std::vector<NamedTrajectory> estimates;
	std::string truth;
	for (const DriveResult& result : drives)
	{
		if (result.sequence != sequence || !isMode(result) || !result.seeds.front().problem.empty()) continue;
		truth = result.seeds.front().ground_truth;
		estimates.push_back({result.variant.name, *result.seeds.front().estimate});
	}
	if (estimates.empty()) return;
	const TrajectoryPictures pictures = trajectoryPictures(Trajectory::loadTum(truth), estimates, EvaluationOptions(), PlotColours::page);
	page.subheading(sequence + ": " + paperSequence(sequence).motion);
	page.beginRow();
	page.figure(pictures.paths, sequence + " from above, in metres: our three modes over the truth (reference). The circle is the start.",
	            true);
	page.figure(pictures.error_over_time, sequence + ": distance from the truth in metres, over time in seconds.");
	page.figure(pictures.drift_over_distance, sequence + ": relative error of pieces of the path, per cent of their length.");
	page.endRow();
}

void addFigure6(HtmlPage& page, const Request& request, const std::vector<DriveResult>& drives)
{
	page.heading("Figure 6: trajectories");
	page.paragraph("Seed " + std::to_string(request.seeds.front()) + ".");
	for (const std::string& sequence : request.sequences) addTrajectories(page, sequence, drives);
}

void addStarts(HtmlPage& page, const Request& request, const std::vector<Start>& starts)
{
	if (request.tables.count(2) != 0)
	{
		page.heading("Table 2: time to the start");
		page.table(table2(starts),
		           "Seconds from the first image after the start. In parentheses: the robot stands or turns on the spot there; these count "
		           "for the first metric pose only.");
	}
	if (request.tables.count(3) != 0)
	{
		page.heading("Table 3: accuracy after the start");
		page.table(table3(starts),
		           "RMSE of the ATE x-y-z in metres over 30 s from where both methods have started; a dash where the trajectory does not "
		           "converge (ATE above 5 % of the length, or scale off by more than 10 %).");
	}
}

void addFigure7(HtmlPage& page, const std::vector<Start>& starts)
{
	BarChart times{"Average time to the start",
	               "time (s)",
	               {},
	               {{"VINS-Mono's method", {}}, {"ours, vision-aligned", {}}, {"ours, first metric pose", {}}, {"paper's system", {}}},
	               1};
	BarChart errors{"Average RMSE in the 30 s after the start",
	                "RMSE (m)",
	                {},
	                {{"VINS-Mono's method", {}, 0}, {"ours", {}, 1}, {"paper's system", {}, 3}},
	                3};
	for (const StartAverages& a : startAverages(starts))
	{
		const PaperSequence& paper = paperSequence(a.sequence);
		times.groups.push_back(a.sequence);
		errors.groups.push_back(a.sequence);
		size_t i = 0;
		for (const double value : {a.vins_s, a.aligned_s, a.first_pose_s, paper.own_time_s.average})
			times.series[i++].values.push_back(value);
		i = 0;
		for (const double value : {a.vins_rmse_m, a.rmse_m, paper.own_rmse_m.average}) errors.series[i++].values.push_back(value);
	}
	page.heading("Figure 7: starts");
	page.beginRow();
	page.figure(toSvg(times, PlotColours::page), "Average time to the start in seconds, by sequence.");
	page.figure(toSvg(errors, PlotColours::page), "Average RMSE of the ATE x-y-z in metres in the 30 s after the start, by sequence.");
	page.endRow();
}

/** Median time of each stage of a frame, of viwo's first seed. */
void addStages(HtmlPage& page, const std::vector<DriveResult>& drives)
{
	const std::vector<std::string> stages{"decode", "track", "estimate", "optimize", "marginalize", "covariance", "frame"};
	BarChart chart{"Time of a frame's stages (median)", "time (ms)", stages, {}, 1};
	for (const DriveResult& result : drives)
	{
		if (result.variant.name != "viwo" || !result.seeds.front().problem.empty()) continue;
		const Json times = loadJson(result.seeds.front().folder + "/summary.json").at("stages_ms");
		chart.series.push_back({result.sequence, {}});
		for (const std::string& stage : stages)
			chart.series.back().values.push_back(times.contains(stage) ? times.at(stage).at("median").get<double>()
			                                                           : std::numeric_limits<double>::quiet_NaN());
	}
	page.heading("Times");
	page.figure(toSvg(chart, PlotColours::page),
	            "Median time of the stages of one frame in milliseconds, by sequence; programs ran side by side on this machine. "
	            "'estimate' contains optimize and marginalize, 'frame' is all.");
}
}  // namespace

std::string reportHtml(const Findings& f)
{
	HtmlPage page("Visual-inertial-wheel odometry: the paper's experiments");
	const bool with_table1 = f.request.tables.count(1) != 0;
	introduce(page, f.request, f.provenance);
	if (with_table1) addTable1(page, f.drives);
	if (!f.lidar.empty()) addLidar(page, f.lidar);
	if (!f.starts.empty()) addStarts(page, f.request, f.starts);
	if (f.request.ablations)
	{
		page.heading("Ablations");
		page.table(ablationTable(f.drives), "RMSE of the ATE x-y-z in metres: viwo, and viwo with one part switched off.");
	}
	if (!f.budgets.empty())
	{
		page.heading("Error budget");
		page.table(
		    errorBudgetTable(f.budgets),
		    "RMSE of the ATE x-y-z of viwo in centimetres, of drives that are simulated with one source of error alone, and with all "
		    "others.");
	}
	if (!f.lidar.empty()) addFigure5(page, f.request, f.lidar);
	if (with_table1) addFigure6(page, f.request, f.drives);
	if (!f.starts.empty()) addFigure7(page, f.starts);
	if (with_table1) addStages(page, f.drives);
	if (!f.drives.empty())
	{
		page.heading("Every run");
		page.table(table1Runs(f.drives), "RMSE of the ATE of each run in metres.");
	}
	if (!f.starts.empty()) page.table(startRuns(f.starts), "Each start.");
	page.details("Configuration of the estimator", f.provenance.configuration);
	return page.toString();
}
}  // namespace viwo::experiments
