#include "TempFolder.h"

#include <viwo/odometry/OdometryOptions.h>

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

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

/** A bar in a table's cell. */
std::string withBars(const std::string& text)
{
	return std::regex_replace(text, std::regex("\\|"), "\\|");
}

/** "key = value // what it does" as the rows of a table for each section. */
std::string tablesOf(const std::string& ini)
{
	std::istringstream lines(ini);
	std::string text;
	for (std::string line; std::getline(lines, line);)
	{
		if (line.empty() || line.front() == '#') continue;
		const size_t equals = line.find(" = "), comment = line.find(" // ");
		if (line.front() == '[')
			text += "\n### `" + line + "`\n| key | default | |\n|---|---|---|\n";
		else
		{
			const std::string value = line.substr(equals + 3, comment - equals - 3);
			text += "| `" + line.substr(0, equals) + "` | " + (value.empty() ? "" : "`" + value + "`") + " | " +
			        withBars(line.substr(comment + 4)) + " |\n";
		}
	}
	return text;
}
}  // namespace

/** The page on tuning says what each key does, in the words of the configuration file. */
TEST(DefaultConfig, EveryKeyIsOnThePageOnTuning)
{
	const std::string page = readFile(VIWO_SOURCE_DIR "/doc/tuning.md"), heading = "## Every parameter\n";
	const std::string fresh = VIWO_BINARY_DIR "/tuning_parameters.md",
	                  tables = tablesOf(save({}, VIWO_BINARY_DIR "/viwo-odometry_default.ini"));
	std::ofstream(fresh) << tables;
	const size_t at = page.find(heading);
	ASSERT_NE(at, std::string::npos);
	EXPECT_EQ(page.substr(at + heading.size()), tables)
	    << "after a change of the options: put " << fresh << " under the last heading of doc/tuning.md";
}

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
