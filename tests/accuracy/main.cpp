#include <viwo/app/Program.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "Groups.h"

using namespace viwo;
using namespace viwo::accuracy;

namespace
{
struct Arguments
{
	std::string output = VIWO_BINARY_DIR "/accuracy";
	std::string programs = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
	std::string only;
	bool list = false;
	size_t jobs = std::max(1U, std::thread::hardware_concurrency());
	Settings settings;
};

void declare(CLI::App& cli, Arguments& a)
{
	cli.add_option("-o,--output", a.output, "Folder for the results, the runs and the simulated logs")->capture_default_str();
	cli.add_option("--only", a.only, "Only the bars whose name contains this; results go to partial.json and .md");
	cli.add_option("--seeds", a.settings.seeds, "Seeds of each drive")->check(CLI::Range(1, 100))->capture_default_str();
	cli.add_option("-j,--jobs", a.jobs, "Programs at a time; speed is measured with one in any case")
	    ->check(CLI::Range(1, 256))
	    ->capture_default_str();
	cli.add_option("--programs", a.programs, "Folder of the programs to measure")->check(CLI::ExistingDirectory)->capture_default_str();
	cli.add_flag("--list", a.list, "Print the names of the bars and do nothing");
	cli.footer(
	    "Writes results.json and results.md: a row for each bar, with name, value, limit and whether it holds.\n"
	    "Real recordings are looked for in the folder named by the environment variable VIWO_TEST_DATA; without it their rows are "
	    "skipped.\n"
	    "Simulated logs are kept under cache/, each under a hash of its inputs: a run that is interrupted goes on where it was.\n"
	    "Exit status: 0 all bars hold, 1 one does not or the measurement failed, 2 bad usage.");
}

bool selected(const std::string& bar, const std::string& only)
{
	return bar.find(only) != std::string::npos;
}

bool anySelected(const Group& group, const std::string& only)
{
	const std::vector<std::string> bars = group.bars();
	return std::any_of(bars.begin(), bars.end(), [&](const std::string& bar) { return selected(bar, only); });
}

/** The group's rows; where its runs cannot be read, rows that hold nowhere and say why. */
std::vector<Row> rowsOf(const Group& group, const Runner& runner)
{
	std::string problem;
	try
	{
		return group.judge(runner);
	}
	catch (const std::exception& e)
	{
		problem = e.what();
	}
	std::vector<Row> rows;
	for (const std::string& bar : group.bars())
	{
		Row row;
		row.name = bar;
		row.detail = problem;
		rows.push_back(row);
	}
	return rows;
}

int measure(Arguments& a)
{
	a.output = std::filesystem::absolute(a.output).string();
	a.settings.folder = a.output;
	std::vector<std::unique_ptr<Group>> groups = allGroups(a.settings);
	groups.erase(std::remove_if(groups.begin(), groups.end(), [&](const auto& g) { return !anySelected(*g, a.only); }), groups.end());
	if (groups.empty()) throw app::UsageError("--only " + a.only + ": there is no such bar; --list prints them");
	if (a.list)
	{
		for (const auto& group : groups)
			for (const std::string& bar : group->bars())
				if (selected(bar, a.only)) std::printf("%s\n", bar.c_str());
		return 0;
	}
	std::filesystem::create_directories(a.output);
	Runner runner(a.output, a.programs);
	for (const auto& group : groups) group->plan(runner);
	const auto tell = [](const JobReport& report) { std::fprintf(stderr, "%s\n", toLine(report).c_str()); };
	if (!runner.execute(a.jobs, {app::interrupted, tell})) throw Error("interrupted; what is finished is kept for the next time");

	Results results;
	for (const auto& group : groups)
		for (const Row& row : rowsOf(*group, runner))
			if (selected(row.name, a.only)) results.add(row);
	const std::string stem = a.output + (a.only.empty() ? "/results" : "/partial");
	results.save(stem);
	std::printf("%s\n%s.json\n%s.md\n", results.toText().c_str(), stem.c_str(), stem.c_str());
	return results.allHold() ? 0 : 1;
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli("Measures the accuracy, the speed and the memory of viwo-odometry, each against its bar.", "viwo_accuracy");
	Arguments arguments;
	if (const char* folder = std::getenv("VIWO_TEST_DATA")) arguments.settings.test_data = folder;
	declare(cli, arguments);
	return app::run(cli, argc, argv, [&] { return measure(arguments); });
}
