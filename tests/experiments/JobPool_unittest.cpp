#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/experiments/JobPool.h>

#include "TempFolder.h"

namespace viwo::experiments
{
namespace
{
class JobPoolTest : public ::testing::Test
{
   protected:
	Job shell(const std::string& label, const std::string& command, std::vector<size_t> after = {}) const
	{
		Job job;
		job.label = label;
		job.after = std::move(after);
		job.command = {"/bin/sh", "-c", command};
		job.log_stem = folder_.file(label);
		return job;
	}

	viwo::testing::TempFolder folder_;
	JobPool pool_;
};

TEST_F(JobPoolTest, WaitsForWhatAJobNeeds)
{
	const std::string file = folder_.file("x");
	const size_t first = pool_.add(shell("first", "sleep 0.2; echo done > " + file)),
	             second = pool_.add(shell("second", "cat " + file, {first}));
	pool_.run(4, {});
	EXPECT_EQ(pool_.error(second), "");
	EXPECT_EQ(viwo::testing::readFile(folder_.file("second.out")), "done\n");
}

TEST_F(JobPoolTest, AFailureFailsWhatNeedsIt)
{
	const size_t first = pool_.add(shell("first", "echo why >&2; exit 1")), second = pool_.add(shell("second", "true", {first})),
	             other = pool_.add(shell("other", "true"));
	pool_.run(1, {});
	EXPECT_EQ(pool_.error(first), "why");
	EXPECT_EQ(pool_.error(second), "first: why");
	EXPECT_EQ(pool_.error(other), "");
}

TEST_F(JobPoolTest, TellsHowFarItIsByCost)
{
	Job there = shell("there", "false");
	there.prepare = [] { return false; };
	there.cost_s = 50;
	Job small = shell("small", "sleep 0.1"), large = shell("large", "sleep 0.1");
	small.cost_s = 10;
	large.cost_s = 40;
	pool_.add(there);
	pool_.add(small);
	pool_.add(large);
	std::vector<JobReport> reports;
	JobHooks hooks;
	hooks.ended = [&](const JobReport& report) { reports.push_back(report); };
	pool_.run(1, hooks);
	ASSERT_EQ(reports.size(), 3u);
	EXPECT_LT(reports[0].left_s, 0) << "what was there already tells nothing of the speed";
	EXPECT_DOUBLE_EQ(reports[0].fraction, 0.5);
	EXPECT_DOUBLE_EQ(reports[1].fraction, 0.6);
	EXPECT_NEAR(reports[1].left_s, 4 * reports[1].elapsed_s, 1e-6);
	EXPECT_EQ(reports[2].left_s, 0);
	EXPECT_NE(toLine(reports[2]).find("[3/3]"), std::string::npos);
}

TEST_F(JobPoolTest, AnInterruptionEndsItsPrograms)
{
	const std::string file = folder_.file("late");
	pool_.add(shell("slow", "sleep 2; echo late > " + file));
	JobHooks hooks;
	hooks.interrupted = [n = 0]() mutable { return ++n > 5; };
	EXPECT_THROW(pool_.run(1, hooks), Error);
	EXPECT_FALSE(std::filesystem::exists(file));
}
}  // namespace
}  // namespace viwo::experiments
