#include "Drives.h"

#include <cmath>

namespace viwo::accuracy
{
std::vector<RunRecipe> runsOf(const SimulatedDrive& drive, int seeds, const std::string& mode, const std::string& variant,
                              const std::vector<std::string>& overrides)
{
	std::vector<RunRecipe> runs;
	for (int seed = 1; seed <= seeds; ++seed)
	{
		RunRecipe run{drive.log(static_cast<uint64_t>(seed))};
		run.mode = mode;
		run.variant = variant;
		run.overrides = overrides;
		runs.push_back(run);
	}
	return runs;
}

std::vector<Score> scoresOf(const Runner& runner, const std::vector<RunRecipe>& runs, double required_coverage)
{
	std::vector<Score> scores;
	for (const RunRecipe& run : runs) scores.push_back(scoreOf(runner.outcome(run), required_coverage));
	return scores;
}

void wantAll(Runner& runner, const std::vector<RunRecipe>& runs)
{
	for (const RunRecipe& run : runs) runner.want(run);
}

double worstExcess(const std::vector<double>& a, const std::vector<double>& b)
{
	std::vector<double> excess;
	for (size_t i = 0; i < a.size(); ++i) excess.push_back(std::isinf(a[i]) ? a[i] : a[i] - b[i]);
	return worst(excess);
}
}  // namespace viwo::accuracy
