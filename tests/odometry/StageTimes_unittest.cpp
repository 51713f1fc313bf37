#include <gtest/gtest.h>
#include <viwo/odometry/StageTimes.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>

namespace viwo
{
namespace
{
static_assert(noexcept(std::declval<StageTimes&>().end(std::declval<const std::string&>())), "it is called in destructors");

void call(StageTimes& times, const std::string& stage, int ms)
{
	times.begin(stage);
	std::this_thread::sleep_for(std::chrono::milliseconds(ms));
	times.end(stage);
}

TEST(StageTimes, StatisticsOfEachStage)
{
	StageTimes times;
	times.begin("frame");
	for (const int ms : {1, 1, 1, 1, 20}) call(times, "solve", ms);
	times.end("frame");
	const StageTimes::Statistics solve = times.statistics("solve"), frame = times.statistics("frame");
	EXPECT_EQ(solve.calls, 5u);
	EXPECT_GE(solve.median_ms, 1);
	EXPECT_LT(solve.median_ms, solve.max_ms);
	EXPECT_GE(solve.max_ms, 20);
	EXPECT_LE(solve.p95_ms, solve.max_ms);
	EXPECT_GT(solve.mean_ms, solve.median_ms);
	EXPECT_EQ(frame.calls, 1u);
	EXPECT_GE(frame.median_ms, 5 * solve.mean_ms * 0.999) << "a stage around others holds their time";
	EXPECT_EQ(times.stages(), (std::vector<std::string>{"frame", "solve"}));
}

TEST(StageTimes, RangesOfCalls)
{
	StageTimes times;
	for (const int ms : {1, 1, 10, 10}) call(times, "x", ms);
	EXPECT_EQ(times.statistics("x", 0, 2).calls, 2u);
	EXPECT_LT(times.statistics("x", 0, 2).max_ms, times.statistics("x", 2, 4).max_ms);
	EXPECT_GE(times.statistics("x", 2, 4).median_ms, 10);
	EXPECT_EQ(times.statistics("x", 3, 99).calls, 1u);
	EXPECT_EQ(times.statistics("x", 4, 9).calls, 0u);
	EXPECT_EQ(times.statistics("x", 3, 1).calls, 0u);
	EXPECT_EQ(times.statistics("never").calls, 0u);
}
}  // namespace
}  // namespace viwo
