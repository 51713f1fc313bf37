#include "ReplayClock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace viwo
{
namespace
{
/** A machine whose time passes when it is told to, and when it sleeps. */
class ReplayClockTest : public ::testing::Test
{
   protected:
	ReplayTime machine()
	{
		return {[this] { return now_s_; },
		        [this](double seconds)
		        {
			        now_s_ += seconds;
			        longest_sleep_s_ = std::max(longest_sleep_s_, seconds);
		        }};
	}

	double now_s_ = 1000, longest_sleep_s_ = 0;
	const std::function<bool()> go_on_ = [] { return false; };
};

TEST_F(ReplayClockTest, WhatIsEarlyWaits)
{
	for (const double speed : {1.0, 4.0})
	{
		now_s_ = 1000;
		ReplayClock clock(speed, machine());
		for (int i = 0; i <= 100; ++i)
		{
			EXPECT_FALSE(clock.waitFor(0.05 * i, go_on_));
			EXPECT_NEAR(now_s_, 1000 + 0.05 * i / speed, 1e-9);
			now_s_ += 0.001;  // what is done with it
		}
		EXPECT_EQ(clock.largestLag_s(), 0);
		EXPECT_NEAR(clock.speed(), speed, 0.01 * speed);
	}
}

TEST_F(ReplayClockTest, AsFastAsItGoesNeverWaits)
{
	ReplayClock clock(0, machine());
	for (int i = 0; i < 10; ++i)
	{
		EXPECT_FALSE(clock.waitFor(i, go_on_));
		now_s_ += 0.1;
	}
	EXPECT_EQ(clock.lag_s(), 0);
	EXPECT_NEAR(clock.speed(), 9, 1e-9);
}

// A machine of half the speed that is needed, then one of ten times it: one remark each way.
TEST_F(ReplayClockTest, FallingBehindIsSaidOnce)
{
	ReplayClock clock(1, machine());
	std::vector<std::string> remarks;
	const auto drive = [&](int from, int to, double work_s)
	{
		for (int i = from; i < to; ++i)
		{
			if (const auto remark = clock.waitFor(0.1 * i, go_on_)) remarks.push_back(*remark);
			now_s_ += work_s;
		}
	};
	drive(0, 31, 0.2);
	ASSERT_EQ(remarks.size(), 1u);
	EXPECT_NE(remarks[0].find(" s behind real time; nothing is dropped"), std::string::npos) << remarks[0];
	EXPECT_NEAR(clock.lag_s(), 3, 1e-6);
	drive(31, 100, 0.01);
	ASSERT_EQ(remarks.size(), 2u);
	EXPECT_EQ(remarks[1], "caught up with real time");
	EXPECT_EQ(clock.lag_s(), 0);
	EXPECT_NEAR(clock.largestLag_s(), 3.1, 1e-6);
}

TEST_F(ReplayClockTest, AHoleOfAnHourCanBeInterrupted)
{
	ReplayClock clock(1, machine());
	clock.waitFor(0, go_on_);
	int asked = 0;
	clock.waitFor(3600, [&] { return ++asked > 20; });
	EXPECT_LT(now_s_, 1003);
	EXPECT_LE(longest_sleep_s_, 0.1);
}
}  // namespace
}  // namespace viwo
