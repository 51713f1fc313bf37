#include <viwo/core/So3.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/ObservationAdapter.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "RawlogFixture.h"
#include "RunProgram.h"

using namespace viwo;
using namespace viwo::testing;
namespace fs = std::filesystem;

namespace
{
/** Rawlogs recorded by others; the folder is not part of the project. */
class RealRawlogs : public ::testing::Test
{
   protected:
	void SetUp() override
	{
		const char* data = std::getenv("VIWO_TEST_DATA");
		if (!data) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
		root = data;
	}
	std::string file(const std::string& name)
	{
		const fs::path path = fs::path(root) / name;
		if (!fs::exists(path)) missing = path.string();
		return path.string();
	}

	std::string root, missing;
};

struct Path
{
	double length_m = 0;
	double yaw_rad = 0;
};

/** Up to that time, from the first reading. */
Path integrate(const std::string& rawlog, const AdapterOptions& options, double end_s = 1e9)
{
	RawlogReaderOptions reader_options;
	reader_options.labels = {options.odometry_label};
	RawlogReader reader(rawlog, reader_options);
	ObservationAdapter adapter(options);
	const WheelIntrinsics wheels = calibrationFrom(options, nullptr, nullptr).wheels;
	Path path;
	std::optional<int64_t> first_t_ns, last_t_ns;
	while (const auto o = reader.next())
	{
		const auto adapted = adapter.convert(o);
		const auto* sample = std::get_if<WheelSample>(&adapted.sample);
		if (!first_t_ns) first_t_ns = nanosecondsOf(o->timestamp);
		if (secondsBetween(*first_t_ns, nanosecondsOf(o->timestamp)) > end_s) break;
		if (!sample && last_t_ns) continue;
		if (sample && last_t_ns)
		{
			const auto twist = twistOf(*sample, wheels);
			const double dt_s = secondsBetween(*last_t_ns, sample->t_ns);
			path.length_m += std::abs(twist.v_m_s) * dt_s;
			path.yaw_rad += twist.w_rad_s * dt_s;
		}
		last_t_ns = nanosecondsOf(o->timestamp);
	}
	for (const auto& [reason, count] : adapter.counts().at(options.odometry_label).rejected)
		std::cout << "[measured] rejected " << reason << ": " << count << "\n";
	return path;
}
}  // namespace

TEST_F(RealRawlogs, ObservationOnly)
{
	const std::string path = file("ual/ual_dataset_2014_05_23_2dlaser_odo.rawlog");
	if (!missing.empty()) GTEST_SKIP() << "no " << missing;
	RawlogReader reader(path);
	EXPECT_EQ(readAll(reader).size(), 18669u);
	EXPECT_EQ(reader.counts().describe(), "ODOMETRY (15351 CObservationOdometry), SICK_FRONT_OBS (3318 CObservation2DRangeScan)");
	const auto& odometry = reader.counts().sensors.at({"ODOMETRY", "CObservationOdometry"});
	EXPECT_NEAR(secondsBetween(odometry.first_t_ns, odometry.last_t_ns), 180.793, 0.05);
}

TEST_F(RealRawlogs, EverySourceOfARealOdometryGivesItsPath)
{
	const std::string path = file("ual/ual_dataset_2014_05_23_2dlaser_odo.rawlog");
	if (!missing.empty()) GTEST_SKIP() << "no " << missing;
	using Source = AdapterOptions::OdometrySource;
	AdapterOptions options;
	options.track_m = 1.250;
	options.metres_per_tick = 1.2910e-4;
	options.right_inverted = true;
	options.min_wheel_interval_s = 0.05;  // its stamps are those of reception, in bunches
	struct Expected
	{
		Source source;
		const char* name;
		double length_m, yaw_rad, yaw_tolerance_rad;
	};
	// The ticks turn more than the pose: here both wheels have one radius, in the pose's calibration two. The velocities are the driver's
	// own estimate.
	const double tick_yaw_rad = (4126556 - 3995531) * 1.2910e-4 / 1.250;
	for (const auto& expected : {Expected{Source::pose, "pose", 524.2, 6.06, 0.02},
	                             {Source::ticks_increment, "ticks_increment", 524.2, tick_yaw_rad, 0.02},
	                             {Source::velocity, "velocity", 536.0, 6.06, 0.4}})
	{
		options.odometry_source = expected.source;
		const Path result = integrate(path, options);
		std::cout << "[measured] " << expected.name << ": " << result.length_m << " m, " << result.yaw_rad << " rad\n";
		EXPECT_NEAR(result.length_m, expected.length_m, 0.003 * expected.length_m) << expected.name;
		EXPECT_NEAR(result.yaw_rad, expected.yaw_rad, expected.yaw_tolerance_rad) << expected.name;
	}
}

/** One number for the two wheels, by the change of heading over the whole drive, explains the heading at every time of it. */
TEST_F(RealRawlogs, ScalesOfTheWheelsMakeTicksAgreeWithThePoses)
{
	const std::string path = file("ual/ual_dataset_2014_05_23_2dlaser_odo.rawlog");
	if (!missing.empty()) GTEST_SKIP() << "no " << missing;
	AdapterOptions poses;
	poses.track_m = 1.250;
	poses.odometry_source = AdapterOptions::OdometrySource::pose;
	poses.min_wheel_interval_s = 0.05;
	AdapterOptions ticks = poses;
	ticks.odometry_source = AdapterOptions::OdometrySource::ticks_increment;
	ticks.metres_per_tick = 1.2910e-4;
	ticks.right_inverted = true;

	const Path expected = integrate(path, poses), raw = integrate(path, ticks);
	const double half_difference = (raw.yaw_rad - expected.yaw_rad) * ticks.track_m / (2 * raw.length_m);
	ticks.left_scale = 1 + half_difference;
	ticks.right_scale = 1 - half_difference;

	const Path got = integrate(path, ticks);
	double worst_rad = 0;
	for (double end_s = 20; end_s <= 180; end_s += 20)
		worst_rad = std::max(worst_rad, std::abs(integrate(path, ticks, end_s).yaw_rad - integrate(path, poses, end_s).yaw_rad));
	std::cout << "[measured] scales " << ticks.left_scale << ", " << ticks.right_scale << ": " << got.length_m << " m, " << got.yaw_rad
	          << " rad; poses " << expected.length_m << " m, " << expected.yaw_rad << " rad; heading apart by " << worst_rad * 180 / M_PI
	          << " deg at most\n";
	EXPECT_NEAR(got.length_m, expected.length_m, 0.002 * expected.length_m);
	EXPECT_NEAR(got.yaw_rad, expected.yaw_rad, M_PI / 180);
	EXPECT_LT(worst_rad, 2.5 * M_PI / 180);
}

TEST_F(RealRawlogs, ActionsAndSensoryFrames)
{
	for (const auto& [name, pairs] : {std::pair{"slam_benchmark/fr079.rawlog", 4934u}, std::pair{"slam_benchmark/intel.rawlog", 13631u}})
	{
		const std::string path = file(name);
		if (!missing.empty()) GTEST_SKIP() << "no " << missing;
		RawlogReader reader(path);
		EXPECT_EQ(readAll(reader).size(), 2 * pairs);
		EXPECT_EQ(reader.counts().entries, 2 * pairs);
		EXPECT_EQ(reader.counts().late, 0u);
		EXPECT_EQ(reader.counts().sensors.at({"ODOMETRY", "CObservationOdometry"}).read, pairs);
	}
}

TEST_F(RealRawlogs, CutShortAnywhere)
{
	const std::string path = file("slam_benchmark/fr079.rawlog");
	if (!missing.empty()) GTEST_SKIP() << "no " << missing;
	const std::string whole = readFile(path);
	TempFolder folder;
	for (size_t cut : {whole.size() / 3, whole.size() / 2, whole.size() - 1})
	{
		writeFile(folder.file("cut.rawlog"), whole.substr(0, cut));
		RawlogReader reader(folder.file("cut.rawlog"));
		const auto read = readUntilError(reader);
		EXPECT_NE(read.error.find("truncated"), std::string::npos) << read.error;
		EXPECT_GT(read.observations.size(), 1000u);
		std::cout << "[measured] of " << whole.size() << " bytes " << cut << " hold " << reader.counts().entries << " entries\n";
	}
}

TEST(MrptDatasets, TheirCountIsThatOfRawlogEdit)
{
	const fs::path datasets = "/usr/share/mrpt/datasets";
	if (!fs::exists(datasets)) GTEST_SKIP() << "no " << datasets << " here (Debian package mrpt-common)";
	if (runProgram("sh", {"-c", "command -v rawlog-edit"}).status != 0) GTEST_SKIP() << "no rawlog-edit here (Debian package mrpt-apps)";
	for (const auto& entry : fs::directory_iterator(datasets))
	{
		if (entry.path().extension() != ".rawlog") continue;
		RawlogReaderOptions options;
		options.skip_missing_images = true;
		RawlogReader reader(entry.path().string(), options);
		EXPECT_FALSE(readAll(reader).empty()) << entry.path();
		const std::string info = runProgram("rawlog-edit", {"--info", "-i", entry.path().string()}).out;
		const auto tells = [&](uint64_t entries)
		{ return info.find("Overall number of objects         : " + std::to_string(entries) + "\n") != std::string::npos; };
		// rawlog-edit reads pairs of action and frame, and passes over a frame at the start that has no action before it.
		const bool in_pairs = info.find("Actions/SensoryFrame format       : Yes") != std::string::npos;
		EXPECT_TRUE(tells(reader.counts().entries) || (in_pairs && tells(reader.counts().entries - 1)))
		    << reader.counts().entries << " entries in " << entry.path() << "; " << info;
	}
}
