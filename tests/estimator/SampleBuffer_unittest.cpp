#include "SampleBuffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace viwo;

namespace
{
constexpr int64_t kMs = 1000000;
// A stamp at Unix epoch: nanoseconds there do not fit into a double.
constexpr int64_t kStart = 1700000000000000001;

/** Samples each 10 ms from kStart; acc.x and gyro.z linear in time. */
ImuBuffer linearImu(int count)
{
	ImuBuffer buffer;
	for (int i = 0; i < count; ++i) EXPECT_TRUE(buffer.add({kStart + 10 * i * kMs, {1. * i, 0, 9.81}, {0, 0, 0.1 * i}}));
	return buffer;
}

/** Samples each 50 ms from kStart: sample i moves at i (left) and 2 i (right). */
WheelBuffer rampWheels(int count)
{
	WheelBuffer buffer;
	for (int i = 0; i < count; ++i) EXPECT_TRUE(buffer.add({kStart + 50 * i * kMs, 1. * i, 2. * i}));
	return buffer;
}
}  // namespace

TEST(ImuBuffer, EndsOnSamplesAreTheSamples)
{
	const auto span = linearImu(6).span(kStart + 10 * kMs, kStart + 30 * kMs, 0.05);
	ASSERT_TRUE(span);
	ASSERT_EQ(span->size(), 3u);
	for (size_t i = 0; i < 3; ++i)
	{
		EXPECT_EQ((*span)[i].t_ns, kStart + 10 * static_cast<int64_t>(i + 1) * kMs);
		EXPECT_EQ((*span)[i].acc_m_s2.x(), static_cast<double>(i + 1));
	}
}

TEST(ImuBuffer, EndsBetweenSamplesAreInterpolated)
{
	const auto span = linearImu(6).span(kStart + 12 * kMs, kStart + 37 * kMs, 0.05);
	ASSERT_TRUE(span);
	ASSERT_EQ(span->size(), 4u);
	EXPECT_EQ(span->front().t_ns, kStart + 12 * kMs);
	EXPECT_EQ(span->back().t_ns, kStart + 37 * kMs);
	EXPECT_NEAR(span->front().acc_m_s2.x(), 1.2, 1e-12);
	EXPECT_NEAR(span->back().gyro_rad_s.z(), 0.37, 1e-12);
	EXPECT_EQ((*span)[1].t_ns, kStart + 20 * kMs);
}

TEST(ImuBuffer, IntervalInsideOneStepHasItsTwoEnds)
{
	const auto span = linearImu(3).span(kStart + 12 * kMs, kStart + 15 * kMs, 0.05);
	ASSERT_TRUE(span);
	ASSERT_EQ(span->size(), 2u);
	EXPECT_NEAR(span->front().acc_m_s2.x(), 1.2, 1e-12);
	EXPECT_NEAR(span->back().acc_m_s2.x(), 1.5, 1e-12);
}

TEST(ImuBuffer, NothingOutsideOfTheSamplesOrWhereTimeStands)
{
	const ImuBuffer buffer = linearImu(6);
	EXPECT_FALSE(buffer.span(kStart - 1, kStart + 20 * kMs, 0.05));
	EXPECT_FALSE(buffer.span(kStart, kStart + 50 * kMs + 1, 0.05));
	EXPECT_TRUE(buffer.span(kStart, kStart + 50 * kMs, 0.05));
	EXPECT_FALSE(buffer.span(kStart + 20 * kMs, kStart + 20 * kMs, 0.05));
	EXPECT_FALSE(buffer.span(kStart + 20 * kMs, kStart + 10 * kMs, 0.05));
	EXPECT_FALSE(ImuBuffer().span(0, 1, 0.05));
	EXPECT_FALSE(ImuBuffer().covers(0));
	EXPECT_EQ(ImuBuffer().latest_ns(), std::numeric_limits<int64_t>::min());
}

TEST(ImuBuffer, GapCountsOnlyWhereItIsUsed)
{
	ImuBuffer buffer = linearImu(3);
	EXPECT_TRUE(buffer.add({kStart + 120 * kMs, {}, {}}));
	EXPECT_TRUE(buffer.add({kStart + 130 * kMs, {}, {}}));
	EXPECT_TRUE(buffer.span(kStart, kStart + 20 * kMs, 0.05));
	EXPECT_FALSE(buffer.span(kStart, kStart + 21 * kMs, 0.05));
	EXPECT_FALSE(buffer.span(kStart + 50 * kMs, kStart + 60 * kMs, 0.05));
	EXPECT_TRUE(buffer.span(kStart + 50 * kMs, kStart + 60 * kMs, 0.1));
	EXPECT_TRUE(buffer.span(kStart + 120 * kMs, kStart + 130 * kMs, 0.05));
}

TEST(ImuBuffer, RefusesStampsThatDoNotIncrease)
{
	ImuBuffer buffer = linearImu(3);
	EXPECT_FALSE(buffer.add({kStart + 20 * kMs, {7, 7, 7}, {}}));
	EXPECT_FALSE(buffer.add({kStart + 15 * kMs, {7, 7, 7}, {}}));
	EXPECT_EQ(buffer.span(kStart + 10 * kMs, kStart + 20 * kMs, 0.05)->back().acc_m_s2.x(), 2.);
}

TEST(ImuBuffer, DroppingKeepsWhatTheNextIntervalNeeds)
{
	ImuBuffer buffer = linearImu(6);
	const auto before = buffer.span(kStart + 25 * kMs, kStart + 50 * kMs, 0.05);
	buffer.dropBefore(kStart + 25 * kMs);
	EXPECT_TRUE(buffer.covers(kStart + 20 * kMs));
	EXPECT_FALSE(buffer.covers(kStart + 20 * kMs - 1));
	const auto after = buffer.span(kStart + 25 * kMs, kStart + 50 * kMs, 0.05);
	ASSERT_TRUE(before && after);
	ASSERT_EQ(before->size(), after->size());
	EXPECT_EQ(before->front().acc_m_s2, after->front().acc_m_s2);
	buffer.dropBefore(kStart + 30 * kMs);
	EXPECT_TRUE(buffer.covers(kStart + 30 * kMs));
	EXPECT_FALSE(buffer.covers(kStart + 30 * kMs - 1));
	buffer.dropBefore(kStart + 1000 * kMs);
	EXPECT_EQ(buffer.latest_ns(), kStart + 50 * kMs);
}

TEST(WheelBuffer, ImagesOnSamplesTakeWholeSamples)
{
	const auto segments = rampWheels(6).segments(kStart + 50 * kMs, kStart + 150 * kMs, 0.2);
	ASSERT_TRUE(segments);
	ASSERT_EQ(segments->size(), 2u);
	EXPECT_NEAR((*segments)[0].dt_s, 0.05, 1e-15);
	EXPECT_EQ((*segments)[0].v_left_m_s, 2);  // the mean over the interval that the sample ends
	EXPECT_EQ((*segments)[1].v_right_m_s, 6);
}

TEST(WheelBuffer, ImageBetweenSamplesSplitsOneAndConservesTravel)
{
	const WheelBuffer buffer = rampWheels(6);
	const auto first = buffer.segments(kStart + 30 * kMs, kStart + 120 * kMs, 0.2);
	const auto second = buffer.segments(kStart + 120 * kMs, kStart + 230 * kMs, 0.2);
	ASSERT_TRUE(first && second);
	ASSERT_EQ(first->size(), 3u);
	EXPECT_NEAR((*first)[0].dt_s, 0.02, 1e-15);
	EXPECT_NEAR((*first)[1].dt_s, 0.05, 1e-15);
	EXPECT_NEAR((*first)[2].dt_s, 0.02, 1e-15);
	EXPECT_EQ((*first)[2].v_left_m_s, 3);
	double left_m = 0;
	for (const auto* part : {&*first, &*second})
		for (const WheelSegment& s : *part) left_m += s.dt_s * s.v_left_m_s;
	EXPECT_NEAR(left_m, 0.02 * 1 + 0.05 * (2 + 3 + 4) + 0.03 * 5, 1e-15);
}

TEST(WheelBuffer, TwoImagesBetweenTwoSamples)
{
	const auto segments = rampWheels(6).segments(kStart + 60 * kMs, kStart + 90 * kMs, 0.2);
	ASSERT_TRUE(segments);
	ASSERT_EQ(segments->size(), 1u);
	EXPECT_NEAR((*segments)[0].dt_s, 0.03, 1e-15);
	EXPECT_EQ((*segments)[0].v_left_m_s, 2);
}

TEST(WheelBuffer, NothingOutsideOfTheSamplesOrOverAGap)
{
	WheelBuffer buffer = rampWheels(3);
	EXPECT_TRUE(buffer.segments(kStart, kStart + 100 * kMs, 0.2));
	EXPECT_FALSE(buffer.segments(kStart - 1, kStart + 100 * kMs, 0.2));
	EXPECT_FALSE(buffer.segments(kStart, kStart + 100 * kMs + 1, 0.2));
	EXPECT_FALSE(buffer.segments(kStart, kStart, 0.2));
	EXPECT_FALSE(WheelBuffer().segments(0, 1, 0.2));
	EXPECT_TRUE(buffer.add({kStart + 1100 * kMs, 1, 1}));
	EXPECT_TRUE(buffer.add({kStart + 1150 * kMs, 1, 1}));
	EXPECT_TRUE(buffer.segments(kStart, kStart + 100 * kMs, 0.2));
	EXPECT_FALSE(buffer.segments(kStart + 50 * kMs, kStart + 150 * kMs, 0.2));
	EXPECT_TRUE(buffer.segments(kStart + 1100 * kMs, kStart + 1150 * kMs, 0.2));
	EXPECT_FALSE(buffer.add({kStart + 1150 * kMs, 2, 2}));
}

TEST(WheelBuffer, DroppingKeepsTheSampleThatBeginsTheNextPiece)
{
	WheelBuffer buffer = rampWheels(6);
	buffer.dropBefore(kStart + 120 * kMs);
	EXPECT_TRUE(buffer.covers(kStart + 100 * kMs));
	EXPECT_FALSE(buffer.covers(kStart + 99 * kMs));
	const auto segments = buffer.segments(kStart + 120 * kMs, kStart + 150 * kMs, 0.2);
	ASSERT_TRUE(segments);
	EXPECT_EQ(segments->front().v_left_m_s, 3);
	EXPECT_EQ(buffer.latest_ns(), kStart + 250 * kMs);
}
