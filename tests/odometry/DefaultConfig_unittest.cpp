#include "TempFolder.h"

#include <viwo/odometry/OdometryOptions.h>

#include <gtest/gtest.h>

using namespace viwo;
using viwo::testing::readFile;

namespace
{
const std::string kShipped = std::string(VIWO_SOURCE_DIR) + "/share/viwo/config_files/viwo-odometry/default.ini";
const std::string kHeader = "Configuration of viwo-odometry: every key with its default. Keys that are left out keep these values.";

std::string save(OdometryOptions options, const std::string& path)
{
	saveOptions(path, options.sections(), kHeader);
	return readFile(path);
}
}  // namespace

/** viwo-odometry without -c and with the shipped file are the same. */
TEST(DefaultConfig, ShippedFileEqualsTheDefaults)
{
	const std::string fresh = VIWO_BINARY_DIR "/viwo-odometry_default.ini";
	EXPECT_EQ(readFile(kShipped), save({}, fresh)) << "after a change of the defaults: cp " << fresh << " " << kShipped;
}

TEST(DefaultConfig, ShippedFileLoadsAndChangesNothing)
{
	const viwo::testing::TempFolder folder;
	OdometryOptions loaded;
	loaded.load(kShipped);
	EXPECT_EQ(save(loaded, folder.file("loaded.ini")), save({}, folder.file("default.ini")));

	OdometryOptions other;
	other.estimator.window.keyframes = 7;
	other.tracker.clahe = true;
	other.rawlog.cam_label = "front";
	other.load(kShipped);
	EXPECT_EQ(save(other, folder.file("other.ini")), save({}, folder.file("default.ini"))) << "a key is missing in the shipped file";
}
