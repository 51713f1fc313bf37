#include "Groups.h"

#include <algorithm>

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
struct Case
{
	SimulatedDrive clean;
	std::string name;
};

std::vector<Case> cases()
{
	return {{corridorDrive(), "corridor"}, {lobbyDrive(), "lobby"}};
}

/** Left and right in turn. */
std::vector<RunRecipe> slipRuns(const SimulatedDrive& clean, int seeds)
{
	const auto left = runsOf(slipping(clean, 0), seeds), right = runsOf(slipping(clean, 1), seeds);
	std::vector<RunRecipe> runs;
	for (size_t i = 0; i < left.size(); ++i) runs.push_back(i % 2 == 0 ? left[i] : right[i]);
	return runs;
}

std::vector<double> slipEvents(const Runner& runner, const std::vector<RunRecipe>& runs)
{
	std::vector<double> events;
	for (const RunRecipe& run : runs)
	{
		const Outcome outcome = runner.outcome(run);
		events.push_back(outcome.failed() ? std::numeric_limits<double>::quiet_NaN() : outcome.summary().at("slip_events").get<double>());
	}
	return events;
}

double smallest(const std::vector<double>& values)
{
	std::vector<double> negated;
	for (const double value : values) negated.push_back(-value);
	return -worst(negated);
}

class Slip : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Slip::bars() const
{
	std::vector<std::string> names;
	for (const Case& c : cases())
		for (const char* what : {": ATE over 1.3 times its own without + 2 cm", ": slip events with slip", ": slip events without"})
			names.push_back("slip (" + c.name + ")" + what);
	return names;
}

void Slip::plan(Runner& runner) const
{
	for (const Case& c : cases())
	{
		wantAll(runner, runsOf(c.clean, settings_.seeds));
		wantAll(runner, slipRuns(c.clean, settings_.seeds));
	}
}

std::vector<Row> Slip::judge(const Runner& runner) const
{
	std::vector<Row> rows;
	for (const Case& c : cases())
	{
		const auto ate = [](const Score& s) { return s.ate_m; };
		const auto clean_runs = runsOf(c.clean, settings_.seeds), slip_runs = slipRuns(c.clean, settings_.seeds);
		const auto slip_scores = scoresOf(runner, slip_runs);
		const std::vector<double> clean = each(scoresOf(runner, clean_runs), ate), slip = each(slip_scores, ate);
		std::vector<double> ratios;
		for (size_t i = 0; i < clean.size(); ++i) ratios.push_back(slip[i] / (1.3 * clean[i] + 0.02));
		const auto with = slipEvents(runner, slip_runs), without = slipEvents(runner, clean_runs);
		const std::string list = listOf("with", slip, 100, "cm") + "; " + listOf("without", clean, 100, "cm") + problemsOf(slip_scores);
		rows.push_back(atMost(bars()[rows.size()], worst(ratios), 1, "", list));
		rows.push_back(atLeast(bars()[rows.size()], smallest(with), 1, "", listOf("", with, 1, "")));
		rows.push_back(atMost(bars()[rows.size()], worst(without), 0, "", listOf("", without, 1, "")));
	}
	return rows;
}
}  // namespace

std::unique_ptr<Group> slip(const Settings& settings)
{
	return std::make_unique<Slip>(settings);
}
}  // namespace viwo::accuracy
