#include "Groups.h"

#include <viwo/experiments/Request.h>

#include <algorithm>

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
/** Above this part of the length a run has diverged. */
constexpr double kDiverged_percent = 5;

struct Part
{
	std::string name, key;
	bool slips = false;  //!< shows only where a wheel slips
};

std::vector<Part> parts()
{
	return {{"plane factor", "plane_factor"},
	        {"wheel factor", "wheel_factor"},
	        {"wheels in the initialisation", "wheels_in_initialization"},
	        {"wheel intrinsics", "estimate_wheel_intrinsics"},
	        {"slip gate", "slip_gate", true}};
}

std::vector<SimulatedDrive> drivesOf(const Part& part)
{
	if (!part.slips) return {corridorDrive(), lobbyDrive()};
	return {slipping(corridorDrive(), 0), slipping(lobbyDrive(), 0)};
}

std::vector<RunRecipe> runs(const SimulatedDrive& drive, const Part& part, int seeds)
{
	return runsOf(drive, seeds, "viwo", "no_" + part.key, {"factors." + part.key + "=false"});
}

double lowestCoverage(const std::vector<Score>& scores)
{
	double lowest = 1;
	for (const Score& score : scores) lowest = std::min(lowest, score.coverage);
	return lowest;
}

class Ablation : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Ablation::bars() const
{
	std::vector<std::string> names;
	for (const Part& part : parts()) names.push_back("without " + part.name + ": worst ATE");
	return names;
}

void Ablation::plan(Runner& runner) const
{
	for (const Part& part : parts())
		for (const SimulatedDrive& drive : drivesOf(part))
		{
			wantAll(runner, runsOf(drive, settings_.seeds));
			wantAll(runner, runs(drive, part, settings_.seeds));
		}
}

std::vector<Row> Ablation::judge(const Runner& runner) const
{
	const auto percent = [](const Score& s) { return s.percent(); };
	std::vector<Row> rows;
	for (const Part& part : parts())
	{
		std::vector<double> all;
		std::string detail;
		for (const SimulatedDrive& drive : drivesOf(part))
		{
			// A part that is off may cost a later start; what then is driven must hold.
			const auto scores = scoresOf(runner, runs(drive, part, settings_.seeds), 0);
			const std::vector<double> off = each(scores, percent), on = each(scoresOf(runner, runsOf(drive, settings_.seeds)), percent);
			detail += (detail.empty() ? "" : "; ") + listOf(drive.name, off, 1, "%") + problemsOf(scores) + ", " +
			          listOf("coverage at least", {lowestCoverage(scores)}, 1, "") + ", " + listOf("median", {median(off)}, 1, "%") +
			          listOf(" with it", {median(on)}, 1, "%");
			all.insert(all.end(), off.begin(), off.end());
		}
		rows.push_back(atMost(bars()[rows.size()], worst(all), kDiverged_percent, "%", detail));
	}
	return rows;
}
}  // namespace

std::unique_ptr<Group> ablation(const Settings& settings)
{
	return std::make_unique<Ablation>(settings);
}
}  // namespace viwo::accuracy
