#include "GapLog.h"

#include <gtest/gtest.h>
#include <viwo/core/Time.h>

namespace viwo
{
namespace
{
TEST(GapLog, TellsWhatIsLongerThanIsBridged)
{
	OdometryOptions options;
	GapLog log(options);
	const double imu_limit_s = options.estimator.window.max_imu_gap_s;
	const auto at = [](double t_s) { return nanoseconds(100 + t_s); };
	EXPECT_FALSE(log.add("IMU", at(0)));
	EXPECT_FALSE(log.add("IMU", at(0.9 * imu_limit_s)));
	EXPECT_FALSE(log.add("ODOMETRY", at(5))) << "the first of a sensor ends no gap";
	const auto gap = log.add("IMU", at(5));
	ASSERT_TRUE(gap);
	EXPECT_EQ(gap->label, "IMU");
	EXPECT_EQ(gap->begin_ns, at(0.9 * imu_limit_s));
	EXPECT_NEAR(gap->duration_s, 5 - 0.9 * imu_limit_s, 1e-9);
	EXPECT_EQ(log.gaps().size(), 1u);
}

TEST(GapLog, EachHoleCountsOnceAlsoTheOneAtTheEnd)
{
	GapLog log{OdometryOptions()};
	for (const double t_s : {0.0, 0.05, 5.0, 5.05, 7.0}) log.add("IMU", nanoseconds(100 + t_s));
	log.add("ODOMETRY", nanoseconds(100));
	log.finish(nanoseconds(107.05));
	EXPECT_EQ(log.count("IMU"), 2u);
	EXPECT_EQ(log.count("ODOMETRY"), 1u) << "silent from the first on";
	EXPECT_EQ(log.count("CAM"), 0u);
	EXPECT_NEAR(log.gaps().back().duration_s, 7.05, 1e-9);
}

TEST(GapLog, SensorsThatTheModeDoesNotUseDoNotCount)
{
	OdometryOptions options;
	options.estimator.mode = Mode::wheel;
	GapLog log(options);
	for (const char* label : {"CAM", "IMU", "LMS100"})
	{
		EXPECT_FALSE(log.add(label, 0));
		EXPECT_FALSE(log.add(label, nanoseconds(100))) << label;
	}
	EXPECT_FALSE(log.add("ODOMETRY", 0));
	EXPECT_TRUE(log.add("ODOMETRY", nanoseconds(100)));
}
}  // namespace
}  // namespace viwo
