#include <StatusLog.h>

#include <viwo/core/Time.h>

#include <gtest/gtest.h>

namespace viwo
{
namespace
{
TEST(StatusLog, ChangesAreLoggedOnceWithTimeAndCause)
{
	StatusLog log{WindowOptions()};
	EXPECT_EQ(log.now(), Status::waiting);
	log.set(Status::waiting, 5, "nothing new");
	EXPECT_TRUE(log.changes().empty());
	log.set(Status::initialising, 7, "first frame");
	log.set(Status::initialising, 8, "second frame");
	ASSERT_EQ(log.changes().size(), 1u);
	EXPECT_EQ(log.changes()[0].t_ns, 7);
	EXPECT_EQ(log.changes()[0].from, Status::waiting);
	EXPECT_EQ(log.changes()[0].to, Status::initialising);
	EXPECT_EQ(log.changes()[0].cause, "first frame");
}

TEST(StatusLog, TrackingIsLostAndFound)
{
	WindowOptions options;
	StatusLog log(options);
	const int enough = options.tracking_min_landmarks;
	log.set(Status::from_wheels, 0, "wheels");
	log.update(nanoseconds(0.1), enough - 1, 100);
	EXPECT_EQ(log.now(), Status::from_wheels);
	log.update(nanoseconds(0.2), enough, 100);
	EXPECT_EQ(log.now(), Status::tracking);
	EXPECT_NE(log.changes().back().cause.find(std::to_string(enough)), std::string::npos);

	log.update(nanoseconds(0.3), 0, 0);
	log.update(nanoseconds(0.2 + options.dead_reckoning_after_s), 0, 0);
	EXPECT_EQ(log.now(), Status::tracking) << "too early";
	log.update(nanoseconds(0.3 + options.dead_reckoning_after_s), 0, 0);
	EXPECT_EQ(log.now(), Status::dead_reckoning);
	log.update(nanoseconds(2), enough / 2, 100);
	EXPECT_EQ(log.now(), Status::dead_reckoning);
	log.update(nanoseconds(3), enough, 100);
	EXPECT_EQ(log.now(), Status::tracking);
}

/** Turning on the spot leaves many landmarks in sight, none with a depth. */
TEST(StatusLog, UnknownDepthsAreNoLossOfTheCamera)
{
	StatusLog log{WindowOptions()};
	log.set(Status::tracking, 0, "start");
	for (int i = 1; i < 100; ++i) log.update(nanoseconds(0.1 * i), 0, 60);
	EXPECT_EQ(log.now(), Status::tracking);
}

/** Without ever having tracked, there is no camera to lose. */
TEST(StatusLog, DarkFromTheStartStaysFromWheels)
{
	StatusLog log{WindowOptions()};
	log.set(Status::from_wheels, 0, "start");
	for (int i = 1; i < 100; ++i) log.update(nanoseconds(0.1 * i), 0, 0);
	EXPECT_EQ(log.now(), Status::from_wheels);
}

TEST(StatusLog, NamesOfAll)
{
	EXPECT_STREQ(toString(Status::waiting), "waiting");
	EXPECT_STREQ(toString(Status::initialising), "initialising");
	EXPECT_STREQ(toString(Status::from_wheels), "from_wheels");
	EXPECT_STREQ(toString(Status::tracking), "tracking");
	EXPECT_STREQ(toString(Status::dead_reckoning), "dead_reckoning");
}
}  // namespace
}  // namespace viwo
