#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/experiments/Experiments.h>

#include <filesystem>

#include "Figures.h"
#include "FolderLock.h"
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
	Writer(std::string folder, const Provenance& provenance, ExperimentResult& result)
	    : folder_(std::move(folder)), provenance_(provenance), result_(result)
	{
	}

	void write(const std::string& name, const std::string& title, const Table& table, Json content)
	{
		Json json = toJson(provenance_);
		json["results"] = std::move(content);
		const std::string remark = provenance_.interruption.empty() ? "" : "\n" + provenance_.interruption + "\n";
		put(name + ".md", "# " + title + "\n\n" + table.toMarkdown() + remark);
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
	const Provenance& provenance_;
	ExperimentResult& result_;
};

std::string interruptionOf(const Runner& runner)
{
	if (runner.open() == 0) return {};
	return "Interrupted: " + std::to_string(runner.open()) + " of " + std::to_string(runner.size()) + " programs have not run; '" +
	       kOpenMark + "' stands where their figures are missing. The same command goes on from here.";
}

std::vector<std::string> problemsOf(const Findings& f)
{
	std::vector<std::string> problems;
	for (const LidarDrive& drive : f.lidar)
		if (!drive.problem.empty() && !drive.open)
			problems.push_back(drive.sequence + ", seed " + std::to_string(drive.seed) + ", ground truth: " + drive.problem);
	for (const DriveResult& drive : f.drives)
		for (const DriveErrors& e : drive.seeds)
			if (e.failed)
				problems.push_back(drive.sequence + ", seed " + std::to_string(e.seed) + ", " + drive.variant.name + ": " + e.problem);
	for (const Start& start : f.starts)
		for (const StartRun* run : {&start.ours, &start.vins})
			if (!run->problem.empty())
				problems.push_back(start.sequence + ", seed " + std::to_string(start.seed) + ", start at " + fixed(start.start_s, 0) +
				                   " s: " + run->problem);
	for (const ErrorBudget& budget : f.budgets) problems.insert(problems.end(), budget.problems.begin(), budget.problems.end());
	return problems;
}

Findings findingsOf(const Runner& runner, const Request& request, const Provenance& provenance)
{
	Findings f{request, provenance, driveResults(runner, request), {}, starts(runner, request), errorBudgets(runner, request)};
	if (provenance.has_truth) f.lidar = lidarDrives(runner, request, f.drives);
	return f;
}

void writeTables(const Findings& f, Writer& writer)
{
	if (f.request.tables.count(1) != 0)
		writer.write("table1", "Table 1: RMSE of the ATE, median over the seeds", table1(f.drives), table1Json(f.drives));
	if (!f.lidar.empty())
		writer.write("table1_lidar", "Table 1 against the ground truth from LiDAR, x-y", table1Lidar(f.lidar), table1LidarJson(f.lidar));
	if (f.request.tables.count(2) != 0) writer.write("table2", "Table 2: time to the start", table2(f.starts), startsJson(f.starts));
	if (f.request.tables.count(3) != 0)
		writer.write("table3", "Table 3: RMSE in the 30 s after the start", table3(f.starts), startsJson(f.starts));
	if (f.request.ablations)
		writer.write("ablations", "Ablations: RMSE of the ATE x-y-z of viwo", ablationTable(f.drives), table1Json(f.drives));
	if (!f.budgets.empty())
		writer.write("error_budget", "Error budget: RMSE of the ATE x-y-z of viwo", errorBudgetTable(f.budgets),
		             errorBudgetJson(f.budgets));
}
}  // namespace

ExperimentResult runExperiments(const Request& request, const ExperimentFolders& folders, size_t jobs, const JobHooks& hooks)
{
	Provenance provenance = provenanceOf(request, folders.programs);
	createFolder(folders.output);
	const std::string output = fs::absolute(folders.output).string();
	// Programs of two measurements in one folder would write over each other's files.
	const FolderLock lock(output);
	if (lock.taken()) throw Error(output + ": another viwo-experiments is at work in this folder; wait for its end, or give another -o");
	Runner runner(output, folders.programs);
	const std::string cache = folders.cache.empty() ? output + "/cache" : fs::absolute(folders.cache).string();
	createFolder(cache);
	runner.keepLogsIn(cache);
	runner.keepRuns(provenance.build, provenance.truth_build);
	planDrives(runner, request);
	if (provenance.has_truth) planLidarTruth(runner, request);
	planStarts(runner, request);
	planErrorBudget(runner, request);

	ExperimentResult result;
	if (!runner.execute(jobs, hooks)) result.interruption = interruptionOf(runner);
	provenance.interruption = result.interruption;
	const Findings findings = findingsOf(runner, request, provenance);
	result.problems = problemsOf(findings);
	Writer writer(output, findings.provenance, result);
	writeTables(findings, writer);
	writer.put("report.html", reportHtml(findings));
	return result;
}
}  // namespace viwo::experiments
