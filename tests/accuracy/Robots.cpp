#include <algorithm>

#include <viwo/experiments/Request.h>

#include "Drives.h"
#include "Groups.h"
#include "RobotVariants.h"

namespace viwo::accuracy
{
namespace
{
constexpr int kMostSeeds = 3;
/** The drives are short: the first 0.8 s of 10 s are before the first pose. */
constexpr double kCoverage = 0.9;

class Robots : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;

   private:
	std::vector<RunRecipe> runs(const RobotVariant& robot) const
	{
		std::vector<RunRecipe> recipes;
		for (int seed = 1; seed <= std::min(settings_.seeds, kMostSeeds); ++seed)
		{
			recipes.emplace_back(robot.log(static_cast<uint64_t>(seed)));
			recipes.back().overrides = robot.configuration;
		}
		return recipes;
	}
};

std::vector<std::string> Robots::bars() const
{
	std::vector<std::string> names;
	for (const RobotVariant& robot : robotVariants(VIWO_TEST_BAGS)) names.push_back("robot, " + robot.name + ": worst ATE");
	return names;
}

void Robots::plan(Runner& runner) const
{
	for (const RobotVariant& robot : robotVariants(VIWO_TEST_BAGS)) wantAll(runner, runs(robot));
}

std::vector<Row> Robots::judge(const Runner& runner) const
{
	std::vector<Row> rows;
	for (const RobotVariant& robot : robotVariants(VIWO_TEST_BAGS))
	{
		const std::vector<Score> scores = scoresOf(runner, runs(robot), kCoverage);
		const std::vector<double> lengths_m = each(scores, [](const Score& score) { return score.length_m; });
		const std::string list = listOf("viwo", each(scores, [](const Score& score) { return score.ate_m; }), 100, "cm");
		rows.push_back(atMost(bars()[rows.size()], worst(each(scores, [](const Score& score) { return score.percent(); })), 1.5, "%",
		                      listOf("of", {median(lengths_m)}, 1, "m: ") + list + problemsOf(scores)));
	}
	return rows;
}
}  // namespace

std::unique_ptr<Group> robots(const Settings& settings)
{
	return std::make_unique<Robots>(settings);
}
}  // namespace viwo::accuracy
