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

class Lobby : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Lobby::bars() const
{
	return {"lobby: median ATE of viwo", "lobby: worst ATE of viwo", "lobby: viwo less vio, worst seed",
	        "lobby: viwo less wheel, worst seed"};
}

void Lobby::plan(Runner& runner) const
{
	for (const char* mode : {"viwo", "vio", "wheel"}) wantAll(runner, runsOf(lobbyDrive(), settings_.seeds, mode));
}

std::vector<Row> Lobby::judge(const Runner& runner) const
{
	const auto scores = [&](const char* mode, double coverage)
	{ return scoresOf(runner, runsOf(lobbyDrive(), settings_.seeds, mode), coverage); };
	const std::vector<Score> viwo = scores("viwo", kRequiredCoverage), vio = scores("vio", 0), wheel = scores("wheel", 0);
	const auto viwo_m = each(viwo, ate), vio_m = each(vio, ate), wheel_m = each(wheel, ate);
	const std::string list = listOf("viwo", viwo_m, 100, "cm") + problemsOf(viwo);

	return {atMost(bars()[0], 100 * median(viwo_m), 2.5, "cm", list), atMost(bars()[1], 100 * worst(viwo_m), 5, "cm", list),
	        atMost(bars()[2], 100 * worstExcess(viwo_m, vio_m), 0, "cm", list + "; " + listOf("vio", vio_m, 100, "cm") + problemsOf(vio)),
	        atMost(bars()[3], 100 * worstExcess(viwo_m, wheel_m), 0, "cm",
	               list + "; " + listOf("wheel", wheel_m, 100, "cm") + problemsOf(wheel))};
}
}  // namespace

std::unique_ptr<Group> lobby(const Settings& settings)
{
	return std::make_unique<Lobby>(settings);
}
}  // namespace viwo::accuracy
