#include <gtest/gtest.h>
#include <viwo/odometry/OdometryOptions.h>

#include "ExpectError.h"
#include "TempFolder.h"

namespace viwo
{
namespace
{
using viwo::testing::readFile;
using viwo::testing::TempFolder;

TEST(OdometryOptions, WhatIsSavedLoadsAgain)
{
	const TempFolder folder;
	OdometryOptions options;
	options.rawlog.track_m = 0.31;
	options.tracker.max_features = 123;
	options.estimator.factors.slip_gate = false;
	options.estimator.noise.imu.gyro_noise_rad_s_sqrtHz = 3.25e-4;
	options.estimator.priors.wheel_scale = 0.02;
	options.estimator.window.keyframes = 12;
	saveOptions(folder.file("a.ini"), options.sections(), "a comment");

	OdometryOptions loaded;
	loaded.load(folder.file("a.ini"));
	EXPECT_EQ(loaded.rawlog.track_m, 0.31);
	EXPECT_EQ(loaded.tracker.max_features, 123);
	EXPECT_FALSE(loaded.estimator.factors.slip_gate);
	EXPECT_EQ(loaded.estimator.noise.imu.gyro_noise_rad_s_sqrtHz, 3.25e-4);
	EXPECT_EQ(loaded.estimator.priors.wheel_scale, 0.02);
	EXPECT_EQ(loaded.estimator.window.keyframes, 12);
	saveOptions(folder.file("b.ini"), loaded.sections(), "a comment");
	EXPECT_EQ(readFile(folder.file("a.ini")), readFile(folder.file("b.ini")));
}

TEST(OdometryOptions, ShippedFilesLoad)
{
	for (const char* name : {"default.ini", "kitti.ini"})
		EXPECT_NO_THROW(OdometryOptions().load(std::string(VIWO_SOURCE_DIR "/share/viwo/config_files/viwo-odometry/") + name)) << name;
}

/** Without a configuration file the program does what the shipped default says. */
TEST(OdometryOptions, ShippedDefaultsAreTheBuiltInOnes)
{
	const TempFolder folder;
	OdometryOptions built_in, shipped;
	shipped.load(VIWO_SOURCE_DIR "/share/viwo/config_files/viwo-odometry/default.ini");
	saveOptions(folder.file("built_in.ini"), built_in.sections());
	saveOptions(folder.file("shipped.ini"), shipped.sections());
	EXPECT_EQ(readFile(folder.file("built_in.ini")), readFile(folder.file("shipped.ini")));
}
}  // namespace
}  // namespace viwo
