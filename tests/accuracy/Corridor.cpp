#include "Groups.h"

#include <viwo/experiments/Request.h>

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
double ate(const Score& s)
{
	return s.ate_m;
}
double percent(const Score& s)
{
	return s.percent();
}

class Corridor : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Corridor::bars() const
{
	return {"corridor: median ATE of viwo", "corridor: worst ATE of viwo", "corridor: viwo less vio, worst seed",
	        "corridor: viwo less wheel, worst seed"};
}

void Corridor::plan(Runner& runner) const
{
	for (const char* mode : {"viwo", "vio", "wheel"}) wantAll(runner, runsOf(corridorDrive(), settings_.seeds, mode));
}

std::vector<Row> Corridor::judge(const Runner& runner) const
{
	const auto scores = [&](const char* mode, double coverage)
	{ return scoresOf(runner, runsOf(corridorDrive(), settings_.seeds, mode), coverage); };
	const std::vector<Score> viwo = scores("viwo", kRequiredCoverage), vio = scores("vio", 0), wheel = scores("wheel", 0);
	const auto viwo_m = each(viwo, ate), vio_m = each(vio, ate), wheel_m = each(wheel, ate), viwo_percent = each(viwo, percent);
	const std::string list = listOf("viwo", viwo_m, 100, "cm") + problemsOf(viwo);
	const std::string length = "of " + std::to_string(viwo.front().length_m).substr(0, 4) + " m: ";

	return {atMost(bars()[0], median(viwo_percent), 0.8, "%", length + list),
	        atMost(bars()[1], worst(viwo_percent), 1.5, "%", length + listOf("viwo", viwo_percent, 1, "%") + problemsOf(viwo)),
	        atMost(bars()[2], 100 * worstExcess(viwo_m, vio_m), 0, "cm", list + "; " + listOf("vio", vio_m, 100, "cm") + problemsOf(vio)),
	        atMost(bars()[3], 100 * worstExcess(viwo_m, wheel_m), 1, "cm",
	               list + "; " + listOf("wheel", wheel_m, 100, "cm") + problemsOf(wheel))};
}
}  // namespace

std::unique_ptr<Group> corridor(const Settings& settings)
{
	return std::make_unique<Corridor>(settings);
}
}  // namespace viwo::accuracy
