#include <viwo/app/Program.h>
#include <viwo/experiments/Experiments.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

using namespace viwo;

namespace
{
struct Arguments
{
	std::string sequences, seeds = "1-5", tables = "1,2,3";
	experiments::ExperimentFolders folders;
	std::string error_budget;
	bool ablations = false;
	size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

void declare(CLI::App& cli, Arguments& a)
{
	a.folders.programs = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
	cli.add_option("--sequences", a.sequences, "Of the paper's six, e.g. seq01,seq05; without it all")->check(app::notEmpty());
	cli.add_option("--seeds", a.seeds, "Seeds of each sequence: numbers and ranges, e.g. 1-5 or 1,2,7")->capture_default_str();
	cli.add_option("--tables", a.tables, "1: accuracy of whole drives; 2: time to start; 3: accuracy after the start; or none")
	    ->capture_default_str();
	cli.add_flag("--ablations", a.ablations, "Also switch the parts of the estimator off one by one (five more runs of each drive)");
	cli.add_option("--error-budget", a.error_budget,
	               "Also tell what each source of error costs: sequences, e.g. seq01,seq05 (26 runs of each)")
	    ->check(app::notEmpty());
	cli.add_option("-j,--jobs", a.jobs, "Programs at a time")->check(CLI::Range(1, 256))->default_str("number of processors");
	cli.add_option("-o,--output", a.folders.output, "Folder for tables, report and runs")
	    ->type_name("DIR")
	    ->required()
	    ->check(app::notEmpty());
	cli.add_option("--cache", a.folders.cache, "Folder for simulated logs (0.2 GB a drive); default: <output>/cache")
	    ->type_name("DIR")
	    ->check(app::notEmpty());
	cli.add_option("--programs", a.folders.programs, "Folder of viwo-sim, viwo-odometry and viwo-groundtruth")
	    ->check(CLI::ExistingDirectory);
	cli.footer(
	    "Repeats the experiments of Niu et al. (Sec. 7) on simulated replicas of their six sequences. Writes table1, table2, table3 and\n"
	    "ablations as .json, .md and .csv, and report.html; table1_lidar, too, where viwo-groundtruth is there. Logs and runs that are "
	    "whole are kept and not made again. Interrupted, it writes what is measured; the same command goes on.\n"
	    "Examples:\n"
	    "  viwo-experiments -o paper\n"
	    "  viwo-experiments --sequences seq05,seq06 --seeds 1 --tables 1 --jobs 2 -o quick\n"
	    "  viwo-experiments --seeds 6 --ablations -o unseen\n"
	    "  viwo-experiments --seeds 1 --tables none --error-budget seq01,seq05 -o budget\n"
	    "Exit status: 0 done, 1 failed, interrupted or a run failed, 2 bad usage.");
}

experiments::Request requestOf(const Arguments& a)
{
	try
	{
		experiments::Request request;
		request.sequences = experiments::parseSequences(a.sequences);
		request.seeds = experiments::parseSeeds(a.seeds);
		request.tables = experiments::parseTables(a.tables);
		request.ablations = a.ablations;
		if (!a.error_budget.empty()) request.error_budget = experiments::parseSequences(a.error_budget);
		if (request.tables.empty() && !request.ablations && request.error_budget.empty())
			throw Error("nothing is asked for: give --tables, --ablations or --error-budget");
		return request;
	}
	catch (const Error& e)
	{
		throw app::UsageError(e.what());
	}
}

int measure(const Arguments& a)
{
	const experiments::Request request = requestOf(a);
	app::ProgressBar bar;
	experiments::JobHooks hooks;
	hooks.interrupted = app::interrupted;
	hooks.running = [&](const experiments::JobReport& report) { bar.update(report.fraction(), report.label); };
	hooks.ended = [&](const experiments::JobReport& report)
	{
		bar.clear();
		if (!app::quiet() && (report.took_s > 0 || !report.error.empty())) std::fprintf(stderr, "%s\n", toLine(report).c_str());
	};
	const experiments::ExperimentResult result = experiments::runExperiments(request, a.folders, a.jobs, hooks);
	bar.clear();
	std::printf("%s", result.summary.c_str());
	for (const std::string& file : result.files) std::printf("%s\n", file.c_str());
	for (const std::string& problem : result.problems) std::fprintf(stderr, "viwo-experiments: %s\n", problem.c_str());
	if (!result.interruption.empty()) std::fprintf(stderr, "viwo-experiments: %s\n", result.interruption.c_str());
	return result.problems.empty() && result.interruption.empty() ? 0 : 1;
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli("The experiments of the paper: accuracy, start and ablations on its six sequences.", "viwo-experiments");
	Arguments arguments;
	declare(cli, arguments);
	return app::run(cli, argc, argv, [&] { return measure(arguments); });
}
