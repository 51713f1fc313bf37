#include <viwo/app/Program.h>

#include <cstdio>

#include <viwo/experiments/SimulationCache.h>
#include "TestLogs.h"

using namespace viwo;

namespace
{
int makeTestLogs()
{
	const experiments::SimulationCache cache(testing::testLogFolder(), VIWO_BINARY_DIR "/bin");
	experiments::JobPool pool;
	std::vector<size_t> jobs;
	for (const experiments::LogRecipe& recipe : testing::testLogRecipes()) jobs.push_back(pool.add(cache.job(recipe)));
	const auto tell = [](const experiments::JobReport& report) { std::fprintf(stderr, "%s\n", experiments::toLine(report).c_str()); };
	if (!pool.run(2, {app::interrupted, tell})) throw Error("interrupted; what is finished is kept for the next time");
	for (const size_t job : jobs)
		if (!pool.error(job).empty()) throw Error(pool.error(job));
	return 0;
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli("Simulates the logs of the end-to-end tests, unless they are there.", "viwo_test_logs");
	return app::run(cli, argc, argv, makeTestLogs);
}
