#include "Groups.h"

#include <algorithm>
#include <cstdio>

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
RunRecipe speedRun()
{
	RunRecipe run = runsOf(corridorDrive(), 1, "viwo", "alone").front();
	run.alone = true;
	return run;
}

RunRecipe longRun()
{
	return {SimulatedDrive{
	    "ten_minutes", "lobby", "lobby_arc", {"lidar.enabled=false", "route.duration_s=600", "route.segments=arc 1 m 5300 deg"}}
	            .log(1)};
}

std::string stagesOf(const Json& summary)
{
	std::string text = "median / p95, ms:";
	for (const auto& [name, stage] : summary.at("stages_ms").items())
	{
		char words[128];
		std::snprintf(words, sizeof words, "%s %s %.1f / %.1f", text.back() == ':' ? "" : ",", name.c_str(),
		              stage.at("median").get<double>(), stage.at("p95").get<double>());
		text += words;
	}
	return text;
}

class SpeedAndMemory : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> SpeedAndMemory::bars() const
{
	return {"speed: times real time", "speed: 95th percentile of a frame", "memory over 10 minutes: peak",
	        "memory over 10 minutes: growth from minute 2 to 10"};
}

void SpeedAndMemory::plan(Runner& runner) const
{
	runner.want(speedRun());
	runner.want(longRun());
}

std::vector<Row> SpeedAndMemory::judge(const Runner& runner) const
{
	const Outcome fast = runner.outcome(speedRun()), long_run = runner.outcome(longRun());
	if (fast.failed() || long_run.failed()) throw Error(fast.error + long_run.error);
	const Json summary = fast.summary(), long_summary = long_run.summary();
	std::vector<double> rss_mb;
	for (const Json& minute : long_summary.at("minutes")) rss_mb.push_back(minute.at("rss_mb").get<double>());
	const std::string memory = listOf("resident at the end of each minute", rss_mb, 1, "MB");
	return {atLeast(bars()[0], summary.at("realtime_factor").get<double>(), 5, "", stagesOf(summary)),
	        atMost(bars()[1], summary.at("stages_ms").at("frame").at("p95").get<double>(), 60, "ms", ""),
	        atMost(bars()[2], long_summary.at("peak_rss_mb").get<double>(), 400, "MB", memory),
	        atMost(bars()[3], rss_mb.at(9) - rss_mb.at(1), 10, "MB", memory)};
}
}  // namespace

std::unique_ptr<Group> speedAndMemory(const Settings& settings)
{
	return std::make_unique<SpeedAndMemory>(settings);
}
}  // namespace viwo::accuracy
