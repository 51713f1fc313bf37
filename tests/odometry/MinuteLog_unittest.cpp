#include "MinuteLog.h"

#include <gtest/gtest.h>

namespace viwo
{
namespace
{
TEST(MinuteLog, CountsFramesOfEachMinute)
{
	MinuteLog log;
	for (int i = 0; i < 1300; ++i) log.addFrame(0.1 * i);
	ASSERT_EQ(log.minutes().size(), 3u);
	EXPECT_NEAR(static_cast<double>(log.minutes()[0].frames), 600, 1);
	EXPECT_NEAR(static_cast<double>(log.minutes()[1].frames), 600, 1);
	EXPECT_NEAR(static_cast<double>(log.minutes()[2].frames), 100, 1);
	for (const auto& minute : log.minutes()) EXPECT_GT(minute.rss_mb, 1);
}

TEST(MinuteLog, MinutesWithoutFramesTakeNoRoom)
{
	MinuteLog log;
	log.addFrame(0);
	log.addFrame(200);
	log.addFrame(1e9);
	ASSERT_EQ(log.minutes().size(), 3u);
	EXPECT_EQ(log.minutes()[1].number, 3u);
	EXPECT_EQ(log.minutes()[1].frames, 1u);
	EXPECT_EQ(log.minutes()[2].number, 16666666u);
}
}  // namespace
}  // namespace viwo
