#include "ExpectError.h"
#include "StandingLog.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>

namespace viwo::testing
{
namespace
{
/** Samples that say which one they are: cell k of the grid must hold k. */
ImuRecord numbered(size_t count, double interval_s)
{
	ImuRecord r;
	for (size_t i = 0; i < count; ++i)
	{
		r.t_ns.push_back(kStandingStart_ns + nanoseconds(static_cast<double>(i) * interval_s));
		for (auto& axis : r.axes) axis.push_back(static_cast<double>(i));
	}
	return r;
}

void remove(ImuRecord& r, size_t begin, size_t end)
{
	const auto cut = [&](auto& v)
	{ v.erase(v.begin() + static_cast<std::ptrdiff_t>(begin), v.begin() + static_cast<std::ptrdiff_t>(end)); };
	cut(r.t_ns);
	for (auto& axis : r.axes) cut(axis);
}

size_t misplaced(const EvenImu& imu)
{
	size_t wrong = 0;
	const auto& cells = imu.axes[0].front();
	for (size_t i = 0; i < cells.size(); ++i) wrong += std::isfinite(cells[i]) && cells[i] != static_cast<double>(i) ? 1 : 0;
	return wrong;
}

TEST(EvenImu, EvenStampsStayAsTheyAre)
{
	const EvenImu imu = evenlySampled(numbered(1000, 0.005));
	ASSERT_EQ(imu.pieces.size(), 1u);
	EXPECT_NEAR(imu.interval_s, 0.005, 1e-9);
	EXPECT_EQ(imu.lost, 0u);
	EXPECT_EQ(imu.pieces[0].cells, 1000u);
	EXPECT_EQ(misplaced(imu), 0u);
	EXPECT_EQ(imu.axes[5], imu.axes[0]);
}

TEST(EvenImu, LostSamplesLeaveTheirCellsEmpty)
{
	ImuRecord r = numbered(5000, 0.005);
	remove(r, 3000, 3400);
	for (size_t i = 2000; i > 100; i -= 97) remove(r, i, i + 1);
	const EvenImu imu = evenlySampled(std::move(r));
	EXPECT_EQ(imu.lost, 420u);
	EXPECT_NEAR(imu.longest_gap_s, 401 * 0.005, 1e-6);
	EXPECT_EQ(imu.pieces[0].cells, 5000u);
	EXPECT_EQ(misplaced(imu), 0u);
}

TEST(EvenImu, JitterAndBunchesAreNoGaps)
{
	for (const bool bunches : {false, true})
	{
		ImuRecord r = numbered(20000, 0.005);
		std::mt19937_64 generator(3);
		std::uniform_real_distribution<double> jitter(0, 0.008);
		int64_t last_ns = 0;
		for (size_t i = 0; i < r.t_ns.size(); ++i)
		{
			// Bunches: eight samples are received together, a microsecond apart.
			if (bunches)
				r.t_ns[i] = r.t_ns[i - i % 8] + nanoseconds(0.04) + static_cast<int64_t>(i % 8) * 1000;
			else
				r.t_ns[i] = std::max(last_ns + 1000, r.t_ns[i] + nanoseconds(jitter(generator)));
			last_ns = r.t_ns[i];
		}
		const EvenImu imu = evenlySampled(std::move(r));
		EXPECT_NEAR(imu.interval_s, 0.005, 2e-6) << bunches;
		EXPECT_LE(imu.lost, 1u) << bunches;
		EXPECT_GT(imu.jitter_s, 1e-3);
	}
}

TEST(EvenImu, StampsWithHardlyASampleAreAnError)
{
	ImuRecord r = numbered(1000, 0.001);
	for (size_t i = 700; i < 1000; ++i) r.t_ns[i] += static_cast<int64_t>(i - 699) * 500'000'000;
	expectError([&] { evenlySampled(std::move(r)); }, {"no even series"});
}

TEST(EvenImu, AClockThatRunsFastLosesNothing)
{
	const EvenImu imu = evenlySampled(numbered(100000, 0.005 * 1.003));
	EXPECT_EQ(imu.lost, 0u);
	EXPECT_NEAR(imu.interval_s, 0.005 * 1.003, 1e-9);
}

TEST(EvenImu, AVeryLongGapStartsAPiece)
{
	ImuRecord r = numbered(4000, 0.005);
	for (size_t i = 2500; i < 4000; ++i) r.t_ns[i] += nanoseconds(3 * 3600.0);
	const EvenImu imu = evenlySampled(std::move(r));
	ASSERT_EQ(imu.pieces.size(), 2u);
	EXPECT_EQ(imu.pieces[0].cells, 2500u);
	EXPECT_EQ(imu.pieces[1].cells, 1500u);
	EXPECT_EQ(imu.lost, 0u);
	EXPECT_NEAR(imu.duration_s(), 20, 1e-6);
}
}  // namespace
}  // namespace viwo::testing
