#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/StampGate.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace viwo
{
namespace
{
/** Seconds since some day in 2023; MRPT stamps would be odd at 0. */
constexpr double kDay_s = 1.7e9;

class StampGateTest : public ::testing::Test
{
   protected:
	void push(double t_s, const std::string& label = "A")
	{
		auto o = mrpt::obs::CObservationOdometry::Create();
		o->sensorLabel = label;
		o->timestamp = mrptTime(nanoseconds(t_s));
		note(gate_.push(o));
	}
	void stream(double from_s, double to_s)
	{
		for (int i = 0; i < std::lround((to_s - from_s) / 0.05); ++i) push(from_s + 0.05 * i);
	}
	void finish() { note(gate_.finish()); }

	StampGate gate_{60, false};
	std::vector<double> passed_s_, rejected_s_;

   private:
	void note(const StampGate::Verdict& v)
	{
		for (const auto& o : v.passed) passed_s_.push_back(secondsBetween(0, nanosecondsOf(o->timestamp)));
		for (const auto& o : v.rejected) rejected_s_.push_back(secondsBetween(0, nanosecondsOf(o->timestamp)));
	}
};

TEST_F(StampGateTest, OneStampFarOffIsKeptOutWhereverItStands)
{
	for (const double wrong_s : {5.0, kDay_s + 1e6, kDay_s + 1e9})
		for (const int position : {0, 1, 50, 99, 100})
		{
			gate_ = StampGate(60, false);
			passed_s_.clear();
			rejected_s_.clear();
			for (int i = 0; i <= 100; ++i)
			{
				if (i == position) push(wrong_s);
				if (i < 100) push(kDay_s + 0.05 * i);
			}
			finish();
			EXPECT_EQ(passed_s_.size(), 100u) << position;
			ASSERT_EQ(rejected_s_.size(), 1u) << position;
			EXPECT_NEAR(rejected_s_[0], wrong_s, 1e-3);
		}
}

TEST_F(StampGateTest, WholeStreamThatGoesOnElsewhereIsAGapWithoutLoss)
{
	for (const double gap_s : {3600.0, -3600.0, 1e9})
	{
		gate_ = StampGate(60, false);
		passed_s_.clear();
		stream(kDay_s, kDay_s + 5);
		const size_t before = passed_s_.size();
		stream(kDay_s + gap_s, kDay_s + gap_s + 5);
		finish();
		EXPECT_EQ(passed_s_.size(), 2 * before);
	}
	EXPECT_TRUE(rejected_s_.empty());
}

TEST_F(StampGateTest, StragglersAcrossAGapDoNotHideIt)
{
	stream(kDay_s, kDay_s + 5);
	push(kDay_s + 3600);
	push(kDay_s + 5.1);
	stream(kDay_s + 3600.05, kDay_s + 3605);
	finish();
	EXPECT_TRUE(rejected_s_.empty());
}

TEST_F(StampGateTest, OneSensorOnAnotherClockDoesNotCarryTheStreamAway)
{
	stream(kDay_s, kDay_s + 5);
	for (int i = 0; i < 200; ++i)
	{
		push(kDay_s + 5 + 0.05 * i);
		push(1000 + 0.05 * i, "B");
	}
	finish();
	EXPECT_EQ(passed_s_.size(), 300u);
	EXPECT_EQ(rejected_s_.size(), 200u);
	EXPECT_LT(*std::max_element(rejected_s_.begin(), rejected_s_.end()), 2000);
}

TEST_F(StampGateTest, ShortLogsPassByTheirMajority)
{
	push(3);
	stream(kDay_s, kDay_s + 1);
	EXPECT_TRUE(passed_s_.empty());
	finish();
	EXPECT_EQ(passed_s_.size(), 20u);
	EXPECT_EQ(rejected_s_.size(), 1u);
}

TEST_F(StampGateTest, TrustedFirstStampKeepsNothingWaiting)
{
	gate_ = StampGate(60, true);
	push(kDay_s);
	EXPECT_EQ(passed_s_.size(), 1u);
	push(kDay_s + 0.1);
	EXPECT_EQ(passed_s_.size(), 2u);
}

TEST_F(StampGateTest, StampsWithoutAnyOrderDoNotPileUp)
{
	push(kDay_s);
	for (int i = 0; i < 50000; ++i) push(1e4 + 1e3 * ((i * 7919) % 40000));
	EXPECT_GT(passed_s_.size() + rejected_s_.size(), 30000u);
}
}  // namespace
}  // namespace viwo
