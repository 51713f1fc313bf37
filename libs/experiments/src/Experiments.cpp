#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/experiments/Accuracy.h>
#include <viwo/experiments/ErrorBudget.h>
#include <viwo/experiments/Experiments.h>
#include <viwo/experiments/LidarTruth.h>
#include <viwo/experiments/Starts.h>

#include <filesystem>

#include "Provenance.h"
#include "Report.h"
#include "TextFiles.h"

namespace viwo::experiments
{
namespace
{
namespace fs = std::filesystem;

/** Writes a table in its forms and remembers their names. */
class Writer
{
   public:
	Writer(std::string folder, ExperimentResult& result) : folder_(std::move(folder)), result_(result) {}

	void write(const std::string& name, const std::string& title, const Table& table, const Json& json)
	{
		put(name + ".md", "# " + title + "\n\n" + table.toMarkdown());
		put(name + ".csv", table.toCsv());
		put(name + ".json", toText(json));
		result_.summary += title + "\n" + table.toText() + "\n";
	}

	void put(const std::string& name, const std::string& content)
	{
		result_.files.push_back(folder_ + "/" + name);
		writeAtomically(result_.files.back(), content);
	}

   private:
	std::string folder_;
	ExperimentResult& result_;
};

Json withProvenance(const Provenance& provenance, const char* key, Json content)
{
	Json json = toJson(provenance);
	json[key] = std::move(content);
	return json;
}

std::vector<std::string> problemsOf(const std::vector<DriveResult>& drives, const std::vector<Start>& starts,
                                    const std::vector<LidarDrive>& lidar)
{
	std::vector<std::string> problems;
	for (const LidarDrive& drive : lidar)
		if (!drive.problem.empty())
			problems.push_back(drive.sequence + ", seed " + std::to_string(drive.seed) + ", ground truth: " + drive.problem);
	for (const DriveResult& drive : drives)
		for (const DriveErrors& e : drive.seeds)
			if (e.failed)
				problems.push_back(drive.sequence + ", seed " + std::to_string(e.seed) + ", " + drive.variant.name + ": " + e.problem);
	for (const Start& start : starts)
		for (const StartRun* run : {&start.ours, &start.vins})
			if (!run->problem.empty())
				problems.push_back(start.sequence + ", seed " + std::to_string(start.seed) + ", start at " + fixed(start.start_s, 0) +
				                   " s: " + run->problem);
	return problems;
}
}  // namespace

ExperimentResult runExperiments(const Request& request, const ExperimentFolders& folders, size_t jobs, const JobHooks& hooks)
{
	fs::create_directories(folders.output);
	const std::string output = fs::absolute(folders.output).string();
	const Provenance provenance = provenanceOf(request, folders.programs);
	Runner runner(output, folders.programs);
	if (!folders.cache.empty()) runner.keepLogsIn(fs::absolute(folders.cache).string());
	runner.keepRuns(provenance.build, provenance.truth_build);
	planDrives(runner, request);
	if (provenance.has_truth) planLidarTruth(runner, request);
	planStarts(runner, request);
	planErrorBudget(runner, request);
	runner.execute(jobs, hooks);

	ExperimentResult result;
	const std::vector<DriveResult> drives = driveResults(runner, request);
	const std::vector<Start> all_starts = starts(runner, request);
	std::vector<LidarDrive> lidar;
	if (provenance.has_truth) lidar = lidarDrives(runner, request, drives);
	result.problems = problemsOf(drives, all_starts, lidar);
	Writer writer(output, result);
	if (request.tables.count(1) != 0)
		writer.write("table1", "Table 1: RMSE of the ATE, median over the seeds", table1(drives),
		             withProvenance(provenance, "results", table1Json(drives)));
	if (!lidar.empty())
		writer.write("table1_lidar", "Table 1 against the ground truth from LiDAR, x-y", table1Lidar(lidar),
		             withProvenance(provenance, "results", table1LidarJson(lidar)));
	if (request.tables.count(2) != 0)
		writer.write("table2", "Table 2: time to the start", table2(all_starts),
		             withProvenance(provenance, "results", startsJson(all_starts)));
	if (request.tables.count(3) != 0)
		writer.write("table3", "Table 3: RMSE in the 30 s after the start", table3(all_starts),
		             withProvenance(provenance, "results", startsJson(all_starts)));
	if (request.ablations)
		writer.write("ablations", "Ablations: RMSE of the ATE x-y-z of viwo", ablationTable(drives),
		             withProvenance(provenance, "results", table1Json(drives)));
	const std::vector<ErrorBudget> budgets = errorBudgets(runner, request);
	for (const ErrorBudget& budget : budgets) result.problems.insert(result.problems.end(), budget.problems.begin(), budget.problems.end());
	if (!budgets.empty())
		writer.write("error_budget", "Error budget: RMSE of the ATE x-y-z of viwo", errorBudgetTable(budgets),
		             withProvenance(provenance, "results", errorBudgetJson(budgets)));
	writer.put("report.html", reportHtml({request, provenance, drives, lidar, all_starts, budgets}));
	return result;
}
}  // namespace viwo::experiments
