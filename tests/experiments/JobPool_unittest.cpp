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
	EXPECT_TRUE(pool_.run(4, {}));
	EXPECT_EQ(pool_.error(second), "");
	EXPECT_EQ(viwo::testing::readFile(folder_.file("second.out")), "done\n");
}

TEST_F(JobPoolTest, AFailureFailsWhatNeedsIt)
{
	const size_t first = pool_.add(shell("first", "echo why >&2; exit 1")), second = pool_.add(shell("second", "true", {first})),
	             other = pool_.add(shell("other", "true"));
	EXPECT_TRUE(pool_.run(1, {}));
	EXPECT_EQ(pool_.error(first), "why");
	EXPECT_EQ(pool_.error(second), "first: why");
	EXPECT_EQ(pool_.error(other), "");
}

TEST_F(JobPoolTest, WhatIsThereIsNotDoneAndCountsForNoTime)
{
	Job there = shell("there", "false");
	there.there = [] { return true; };
	there.cost_s = 1000;
	Job small = shell("small", "sleep 0.2"), large = shell("large", "sleep 0.1");
	small.cost_s = 10;
	large.cost_s = 40;
	pool_.add(small);
	pool_.add(large);
	pool_.add(there);
	std::vector<JobReport> reports;
	JobHooks hooks;
	hooks.ended = [&](const JobReport& report) { reports.push_back(report); };
	EXPECT_TRUE(pool_.run(1, hooks));
	ASSERT_EQ(reports.size(), 3u);
	EXPECT_EQ(reports[0].label, "there") << "looked at before anything runs";
	EXPECT_NEAR(reports[0].left_s, 50, 1e-6) << "costs are seconds until something is done";
	EXPECT_LT(reports[0].fraction(), 0.01);
	EXPECT_NEAR(reports[1].left_s, 40 * (reports[1].took_s + 10) / (10 + 10), 1e-6);
	EXPECT_EQ(reports[2].left_s, 0);
	EXPECT_EQ(reports[2].fraction(), 1);
	EXPECT_NE(toLine(reports[2]).find("[3/3]"), std::string::npos);
}

TEST_F(JobPoolTest, WhatRunsIsTakenIntoAccountForTheTimeThatIsLeft)
{
	for (const char* label : {"a", "b", "c", "d"}) pool_.add(shell(label, "sleep 0.4"));
	std::vector<JobReport> reports;
	JobHooks hooks;
	hooks.running = [&](const JobReport& report) { reports.push_back(report); };
	EXPECT_TRUE(pool_.run(2, hooks));
	double most_s = 0;
	for (const JobReport& report : reports)
		if (report.done >= 2 && report.left_s > 0) most_s = std::max(most_s, report.left_s);
	std::cout << "[measured] left after half of four jobs of 0.4 s, two at a time: " << most_s << " s\n";
	EXPECT_GT(most_s, 0.2);
	EXPECT_LT(most_s, 1.5);
}

TEST_F(JobPoolTest, AnInterruptionEndsItsProgramsAndLeavesTheRestOpen)
{
	const std::string file = folder_.file("late");
	Job there = shell("there", "false");
	there.there = [] { return true; };
	const size_t done = pool_.add(there), slow = pool_.add(shell("slow", "sleep 2; echo late > " + file)),
	             after = pool_.add(shell("after", "true", {slow}));
	JobHooks hooks;
	hooks.interrupted = [n = 0]() mutable { return ++n > 5; };
	EXPECT_FALSE(pool_.run(1, hooks));
	EXPECT_FALSE(std::filesystem::exists(file));
	EXPECT_FALSE(pool_.open(done));
	EXPECT_TRUE(pool_.open(slow));
	EXPECT_TRUE(pool_.open(after));
	EXPECT_EQ(pool_.open(), 2u);
	EXPECT_EQ(pool_.error(slow), "");
}

/** Ctrl-C on a terminal goes to all programs: they end with status 1 for it, which is no failure of theirs. */
TEST_F(JobPoolTest, AProgramThatEndsForTheInterruptionHasNotFailed)
{
	const size_t job = pool_.add(shell("ends", "sleep 0.1; exit 1"));
	JobHooks hooks;
	// Seen right after the program has ended, before its end is judged.
	hooks.interrupted = [&, n = 0]() mutable { return std::filesystem::exists(folder_.file("ends.err")) && ++n > 1; };
	EXPECT_FALSE(pool_.run(1, hooks));
	EXPECT_TRUE(pool_.open(job));
}
}  // namespace
}  // namespace viwo::experiments
