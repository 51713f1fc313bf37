#include "StreamClock.h"

#include <gtest/gtest.h>
#include <viwo/core/Time.h>

namespace viwo
{
namespace
{
int64_t at(double t_s)
{
	return nanoseconds(1000 + t_s);
}

TEST(StreamClock, IsTheNewestStamp)
{
	StreamClock clock(10);
	for (const double t_s : {0.0, 1.0, 0.5, 2.0, 1.9}) clock.advance(at(t_s));
	EXPECT_EQ(clock.now_ns(), at(2));
	EXPECT_EQ(clock.pastHoles(at(1.5)), at(1.5));
}

TEST(StreamClock, LongHolesAreSkippedAfterTheFill)
{
	StreamClock clock(10);
	for (const double t_s : {0.0, 9.0, 1e6, 1e6 + 1, 1e9}) clock.advance(at(t_s));
	EXPECT_EQ(clock.pastHoles(at(5)), at(5));
	EXPECT_EQ(clock.pastHoles(at(19)), at(19)) << "still filled";
	EXPECT_EQ(clock.pastHoles(at(19.1)), at(1e6));
	EXPECT_EQ(clock.pastHoles(at(1e6 + 0.1)), at(1e6 + 0.1));
	EXPECT_EQ(clock.pastHoles(at(1e6 + 12)), at(1e9)) << "each hole for itself";
	EXPECT_EQ(clock.pastHoles(at(1e9 + 1)), at(1e9 + 1));
}

TEST(StreamClock, ShortHolesAreNone)
{
	StreamClock clock(10);
	clock.advance(at(0));
	clock.advance(at(9.9));
	EXPECT_EQ(clock.pastHoles(at(9.8)), at(9.8));
}
}  // namespace
}  // namespace viwo
