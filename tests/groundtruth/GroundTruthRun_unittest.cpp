#include "ExpectError.h"
#include "RoomLog.h"
#include "RunProgram.h"

#include <viwo/core/Trajectory.h>
#include <viwo/groundtruth/GroundTruthRun.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

using namespace viwo;
using namespace viwo::gt;
using namespace viwo::testing;

namespace
{
GroundTruthRunOptions optionsFor(const TempFolder& folder, const std::string& out = "out")
{
	GroundTruthRunOptions options;
	options.rawlogs = {folder.file("x.rawlog")};
	options.output_dir = folder.file(out);
	return options;
}

struct Errors
{
	double rms_m = 0, max_m = 0;
};

/** Against the truth, both seen from the first pose. */
Errors errorsOf(const TempFolder& folder, const RoomLog& log, const std::string& out = "out")
{
	const Trajectory trajectory = Trajectory::loadTum(folder.file(out + "/trajectory.tum"));
	EXPECT_EQ(trajectory.size(), log.truth.size());
	Errors errors;
	const auto pose2 = [](const Pose3& T) { return Pose2(T.p.x(), T.p.y(), yawOf(T.R)); };
	for (size_t i = 0; i < log.truth.size(); ++i)
	{
		const Pose2 estimate = between(pose2(trajectory.poses()[0].T), pose2(trajectory.poses()[i].T));
		const double e = (estimate.p - between(log.truth[0], log.truth[i]).p).norm();
		errors.rms_m += e * e / static_cast<double>(log.truth.size());
		errors.max_m = std::max(errors.max_m, e);
	}
	errors.rms_m = std::sqrt(errors.rms_m);
	return errors;
}
}  // namespace

TEST(GroundTruthRun, TwiceAroundTheBlock)
{
	const TempFolder folder;
	RoomLog log;
	log.write(folder.file("x.rawlog"));
	GroundTruthRunOptions options = optionsFor(folder);
	const GroundTruthRunResult result = runGroundTruth(options);
	const Errors e = errorsOf(folder, log);
	std::cout << "[measured] " << result.loops_accepted << " loops, rms " << e.rms_m << " m, max " << e.max_m << " m\n";
	EXPECT_GT(result.loops_accepted, 2u);
	EXPECT_LT(e.rms_m, 0.04);
	EXPECT_EQ(result.odometry_only, 0u);
	for (const char* name : {"trajectory.tum", "trajectory_covariance.csv", "graph.g2o", "graph_stamps.csv", "map.yaml", "map.pgm",
	                         "map.png", "map.simplemap", "map.gridmap.gz", "summary.json", "config.ini"})
		EXPECT_GT(std::filesystem::file_size(folder.file(std::string("out/") + name)), 0u) << name;

	// The same bytes with two threads.
	options = optionsFor(folder, "two");
	options.threads = 2;
	runGroundTruth(options);
	for (const char* name : {"trajectory.tum", "trajectory_covariance.csv", "graph.g2o", "map.pgm", "map.png", "map.simplemap"})
		EXPECT_EQ(readFile(folder.file(std::string("out/") + name)), readFile(folder.file(std::string("two/") + name))) << name;

	// Another program reads the map.
	const ProgramResult read = runProgram("/usr/bin/ros-map-yaml2mrpt", {"-i", folder.file("out/map.yaml"), "-d", folder.path(), "-w"});
	EXPECT_EQ(read.status, 0) << read.out << read.err;
}

TEST(GroundTruthRun, AWrongLoopByHandIsRejected)
{
	const TempFolder folder;
	RoomLog log;
	log.write(folder.file("x.rawlog"));
	GroundTruthRunOptions options = optionsFor(folder);
	options.extra_loops = {{20, 140, 0, 0, 0}, {60, 250, 1, 0, 1.5}};
	const GroundTruthRunResult result = runGroundTruth(options);
	const GroundTruthRunResult clean = runGroundTruth(optionsFor(folder, "clean"));
	const Errors with = errorsOf(folder, log), without = errorsOf(folder, log, "clean");
	std::cout << "[measured] rms with wrong loops " << with.rms_m << " m, without " << without.rms_m << " m\n";
	EXPECT_EQ(clean.loops_rejected, 0u);
	EXPECT_EQ(result.loops_rejected, 2u);
	EXPECT_NEAR(with.rms_m, without.rms_m, 0.01);
}

TEST(GroundTruthRun, WithoutOdometry)
{
	const TempFolder folder;
	RoomLog log;
	log.with_odometry = false;
	log.write(folder.file("x.rawlog"));
	const GroundTruthRunResult result = runGroundTruth(optionsFor(folder));
	const Errors e = errorsOf(folder, log);
	std::cout << "[measured] rms " << e.rms_m << " m\n";
	EXPECT_LT(e.rms_m, 0.05);
	ASSERT_FALSE(result.notes.empty());
	EXPECT_NE(result.notes.back().find("constant velocity"), std::string::npos);
}

TEST(GroundTruthRun, SurvivesBadSensors)
{
	struct Case
	{
		const char* name;
		double bound_m;
		std::function<void(RoomLog&)> make;
	};
	const float nan = std::numeric_limits<float>::quiet_NaN();
	const std::vector<Case> cases{
	    {"odometry jumps", 0.05,
	     [](RoomLog& log)
	     {
		     log.disturb = [](int i, std::vector<float>&, Pose2& odometry)
		     {
			     if (i == 200) odometry = odometry * Pose2(0.5, 0, 30 * M_PI / 180);
		     };
	     }},
	    {"5 s without scans", 0.15, [](RoomLog& log) { log.has_scan = [](int i) { return i < 150 || i >= 200; }; }},
	    {"blind scans", 0.15,
	     [](RoomLog& log)
	     {
		     log.disturb = [](int i, std::vector<float>& r, Pose2&)
		     {
			     if (i >= 100 && i < 120) r.assign(r.size(), 0.f);
		     };
	     }},
	    {"NaN ranges", 0.05,
	     [nan](RoomLog& log)
	     {
		     log.disturb = [nan](int i, std::vector<float>& r, Pose2&)
		     {
			     for (size_t k = static_cast<size_t>(i % 7); k < r.size(); k += 7) r[k] = nan;
		     };
	     }},
	};
	for (const Case& c : cases)
	{
		SCOPED_TRACE(c.name);
		const TempFolder folder;
		RoomLog log;
		c.make(log);
		log.write(folder.file("x.rawlog"));
		const GroundTruthRunResult result = runGroundTruth(optionsFor(folder));
		const Errors e = errorsOf(folder, log);
		std::cout << "[measured] " << c.name << ": rms " << e.rms_m << " m, max " << e.max_m << " m, " << result.odometry_only
		          << " by odometry only\n";
		EXPECT_LT(e.rms_m, c.bound_m);
		EXPECT_GE(result.odometry_only, std::string(c.name) == "blind scans" ? 20u : 0u);
	}
}

TEST(GroundTruthRun, SaysWhatIsWrongInOneLine)
{
	const TempFolder folder;
	expectError([&] { runGroundTruth(optionsFor(folder)); }, {"x.rawlog", "no such file"});
	RoomLog log;
	log.scans = 5;
	log.beams = 1;
	log.write(folder.file("x.rawlog"));
	expectError([&] { runGroundTruth(optionsFor(folder)); }, {"x.rawlog", "no usable scans", "--scan-label"});
	log.beams = 181;
	log.disturb = [](int, std::vector<float>& r, Pose2&) { r.assign(r.size(), 0.f); };
	log.write(folder.file("x.rawlog"));
	expectError([&] { runGroundTruth(optionsFor(folder)); }, {"x.rawlog", "none of the 5 scans"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("out/trajectory.tum")));
}

TEST(GroundTruthProgram, HelpAndUsage)
{
	const std::string program = VIWO_BINARY_DIR "/bin/viwo-groundtruth";
	const ProgramResult help = runProgram(program, {"--help"});
	EXPECT_EQ(help.status, 0);
	EXPECT_NE(help.out.find("Examples:"), std::string::npos);
	EXPECT_EQ(runProgram(program, {}).status, 2);
	const ProgramResult failed = runProgram(program, {"-i", "absent.rawlog", "-o", "/nowhere/at/all"});
	EXPECT_EQ(failed.status, 1);
	EXPECT_EQ(failed.errorLines(), 1u) << failed.err;
}

TEST(GroundTruthProgram, SampleRawlog)
{
	const TempFolder folder;
	const ProgramResult result = runProgram(VIWO_BINARY_DIR "/bin/viwo-groundtruth",
	                                        {"-i", VIWO_SOURCE_DIR "/rawlogs/sample.rawlog", "-o", folder.file("out"), "--holdout"});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(readFile(folder.file("out/summary.json")).find("\"holdout\""), std::string::npos);
}
