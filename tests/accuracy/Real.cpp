#include "Groups.h"

#include <viwo/app/Program.h>

#include <algorithm>
#include <filesystem>

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
std::vector<RunRecipe> kittiRuns(const Settings& settings, const std::string& mode)
{
	std::vector<RunRecipe> runs;
	for (int seed = 1; seed <= settings.seeds; ++seed)
	{
		const std::vector<std::string> options = {"--speed-noise", "0.05", "--speed-scale", "1.01", "--seed", std::to_string(seed)};
		RunRecipe run{importedLog("kitti-s" + std::to_string(seed), "kitti", settings.test_data + "/kitti_snippet", options)};
		run.mode = mode;
		run.config = "kitti.ini";
		runs.push_back(run);
	}
	return runs;
}

RunRecipe eurocRun(const Settings& settings)
{
	RunRecipe run{importedLog("euroc_micro", "euroc", settings.test_data + "/euroc_micro", {})};
	run.mode = "vio";
	return run;
}

/** The camera hardly moves: either there is no pose and a reason, or the poses stay where they are. */
Row eurocRow(const std::string& name, const Outcome& outcome)
{
	if (outcome.failed())
	{
		const bool says_why = outcome.error.find("no pose: the estimator is still") != std::string::npos;
		return atMost(name, says_why ? 0 : NAN, 5, "cm", outcome.error);
	}
	const Trajectory trajectory = outcome.trajectory();
	double moved_m = 0;
	for (const StampedPose& pose : trajectory.poses()) moved_m = std::max(moved_m, (pose.T.p - trajectory.poses().front().T.p).norm());
	return atMost(name, 100 * moved_m, 5, "cm", std::to_string(trajectory.size()) + " poses");
}

class Real : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Real::bars() const
{
	return {"KITTI: worst ATE x-y of viwo", "KITTI: viwo over wheel, worst seed", "EuRoC, hardly moving: distance moved"};
}

void Real::plan(Runner& runner) const
{
	if (settings_.test_data.empty()) return;
	for (const char* mode : {"viwo", "vio", "wheel"}) wantAll(runner, kittiRuns(settings_, mode));
	runner.want(eurocRun(settings_));
}

std::vector<Row> Real::judge(const Runner& runner) const
{
	std::vector<Row> rows;
	if (settings_.test_data.empty())
	{
		for (const std::string& bar : bars()) rows.push_back(skippedRow(bar, "VIWO_TEST_DATA is not set"));
		return rows;
	}
	const auto percent = [&](const char* mode, std::string& problems)
	{
		const auto scores = scoresOf(runner, kittiRuns(settings_, mode), std::string(mode) == "viwo" ? kRequiredCoverage : 0);
		problems += problemsOf(scores);
		return each(scores, [](const Score& s) { return s.percentXy(); });
	};
	std::string problems;
	const std::vector<double> viwo = percent("viwo", problems), wheel = percent("wheel", problems), vio = percent("vio", problems);
	std::vector<double> ratios;
	for (size_t i = 0; i < viwo.size(); ++i) ratios.push_back(viwo[i] / wheel[i]);
	const std::string list =
	    listOf("viwo", viwo, 1, "") + "; " + listOf("wheel", wheel, 1, "") + "; " + listOf("vio", vio, 1, "%") + problems;
	return {atMost(bars()[0], worst(viwo), 0.4, "%", list), atMost(bars()[1], worst(ratios), 1.1, "", listOf("", ratios, 1, "")),
	        eurocRow(bars()[2], runner.outcome(eurocRun(settings_)))};
}
}  // namespace

std::unique_ptr<Group> real(const Settings& settings)
{
	return std::make_unique<Real>(settings);
}
}  // namespace viwo::accuracy
