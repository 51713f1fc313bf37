#include "ExpectError.h"
#include "RoomRun.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <random>

using namespace viwo;
using namespace viwo::gt;
using namespace viwo::testing;

namespace
{
struct Case
{
	const char* name;
	double bound_m;
	const char* note;      //!< what the user is told, in one of the lines
	size_t odometry_only;  //!< poses with that flag, at least
	size_t left_out;       //!< scans
	std::function<void(RoomLog&)> make;
};

/** A disturbance of ranges alone. */
std::function<void(RoomLog&)> ranges(const std::function<void(int, std::vector<float>&)>& change)
{
	return [change](RoomLog& log) { log.disturb = [change](int i, std::vector<float>& r, Pose2&) { change(i, r); }; };
}

std::vector<Case> badOdometry()
{
	return {
	    {"odometry jumps", 0.05, "odometry jumped 1 times against the scans, by up to 0.5", 0, 0,
	     [](RoomLog& log)
	     {
		     log.disturb = [](int i, std::vector<float>&, Pose2& odometry)
		     {
			     if (i == 200) odometry = odometry * Pose2(0.5, 0, 30 * M_PI / 180);
		     };
	     }},
	    {"odometry is reset, leaps and turns", 0.05, "odometry leapt 3 times as no robot drives", 0, 0,
	     [](RoomLog& log)
	     {
		     log.disturb = [](int i, std::vector<float>&, Pose2& odometry)
		     {
			     if (i == 100) odometry = Pose2();
			     if (i == 300) odometry = odometry * Pose2(0, -3, 0);
			     if (i == 450) odometry = odometry * Pose2(0, 0, 2);
		     };
	     }},
	    {"odometry leaps less than a robot may drive", 0.06, "odometry jumped 1 times against the scans, by up to 1.", 0, 480,
	     [](RoomLog& log)
	     {
		     log.disturb = [](int i, std::vector<float>&, Pose2& odometry)
		     {
			     if (i == 200) odometry = odometry * Pose2(-1.2, 0.3, -0.6);
		     };
		     log.odometry_stride = 5;
		     log.has_scan = [](int i) { return i % 5 == 0; };
	     }},
	    {"wild odometry", 0.05, "3 odometry readings that are wild", 0, 0,
	     [](RoomLog& log)
	     {
		     log.written = [](int i, Pose2 odometry)
		     {
			     const double inf = std::numeric_limits<double>::infinity();
			     if (i == 100) odometry = Pose2(1e9, -1e9, 1);
			     if (i == 200) odometry = Pose2(inf, 0, 0);
			     if (i == 300) odometry = Pose2(0, std::nan(""), 0);
			     return odometry;
		     };
	     }},
	    {"odometry flickers", 0.05, "2 odometry readings that are wild", 0, 0,
	     [](RoomLog& log)
	     { log.written = [](int i, const Pose2& odometry) { return i == 100 || i == 101 ? Pose2(1e6, 50, 0) : odometry; }; }},
	    {"nothing but wild odometry", 0.06, "odometry is not used: most of its steps", 0, 0,
	     [](RoomLog& log) { log.written = [](int i, const Pose2&) { return Pose2((i % 7) * 1e6, (i % 5) * 1e5, i); }; }},
	};
}

std::vector<Case> badScans()
{
	const float nan = std::numeric_limits<float>::quiet_NaN();
	return {
	    {"scans of noise", 0.05, "20 scans are noise", 20, 0,
	     ranges(
	         [](int i, std::vector<float>& r)
	         {
		         std::mt19937 random(static_cast<unsigned>(i));
		         if (i >= 100 && i < 120)
			         for (float& one : r) one = 0.1f + 10 * static_cast<float>(random()) / static_cast<float>(random.max());
	         })},
	    {"5 s without scans", 0.15, "1 times no scan for more than 1 s, at most for 5.1 s", 0, 50,
	     [](RoomLog& log) { log.has_scan = [](int i) { return i < 150 || i >= 200; }; }},
	    {"blind scans", 0.15, "20 scans have no valid beam", 20, 0,
	     ranges(
	         [](int i, std::vector<float>& r)
	         {
		         if (i >= 100 && i < 120) r.assign(r.size(), 0.f);
	         })},
	    {"NaN ranges", 0.05, "ranges are no numbers", 0, 0,
	     ranges(
	         [nan](int i, std::vector<float>& r)
	         {
		         for (size_t k = static_cast<size_t>(i % 7); k < r.size(); k += 7) r[k] = nan;
	         })},
	    {"scans of one beam", 0.05, "scans without beams", 0, 60,
	     ranges(
	         [](int i, std::vector<float>& r)
	         {
		         if (i % 10 == 5) r.resize(1);
	         })},
	    {"one stamp goes back", 0.05, "stamps do not increase", 0, 1,
	     [](RoomLog& log) { log.stamp_ns = [](int i) { return RoomLog::kStart_ns + (i == 300 ? 100 : i) * RoomLog::kPeriod_ns; }; }},
	    {"the clock is set back", 0.05, "stamps do not increase", 0, 50,
	     [](RoomLog& log) { log.stamp_ns = [](int i) { return RoomLog::kStart_ns + (i < 550 ? i : i - 300) * RoomLog::kPeriod_ns; }; }},
	};
}

void expectSurvived(const Case& c)
{
	SCOPED_TRACE(c.name);
	const TempFolder folder;
	RoomLog log;
	c.make(log);
	log.write(folder.file("x.rawlog"));
	const GroundTruthRunResult result = runGroundTruth(optionsFor(folder));
	const RoomErrors e = errorsOf(folder, log);
	std::cout << "[measured] " << c.name << ": rms " << e.rms_m << " m, max " << e.max_m << " m, " << result.odometry_only
	          << " by odometry only, " << e.poses << " poses\n";
	EXPECT_LT(e.rms_m, c.bound_m);
	EXPECT_GE(result.odometry_only, c.odometry_only);
	EXPECT_LE(e.poses, 600 - std::min<size_t>(c.left_out, 600));
	EXPECT_GE(e.poses, 600 - c.left_out - 2);
	size_t told = 0;
	for (const std::string& note : result.notes)
	{
		told += note.find(c.note) != std::string::npos;
		EXPECT_EQ(note.find('\n'), std::string::npos);
	}
	EXPECT_EQ(told, 1u) << (result.notes.empty() ? "no note" : result.notes.front());
}
}  // namespace

TEST(GroundTruthBadInput, OfOdometryIsSurvivedFlaggedAndTold)
{
	for (const Case& c : badOdometry()) expectSurvived(c);
}

TEST(GroundTruthBadInput, OfScansIsSurvivedFlaggedAndTold)
{
	for (const Case& c : badScans()) expectSurvived(c);
}

/** As MRPT's demonstration logs are: pairs of action and sensory frame, actions without a stamp. */
TEST(GroundTruthBadInput, ActionsWithoutStampsTakeThatOfTheirFrame)
{
	const TempFolder folder;
	RoomLog log;
	mrpt::obs::CRawlog pairs;
	Pose2 last;
	log.scans = 300;
	for (int i = 0; i < log.scans; ++i)
	{
		const Pose2 T = RoomLog::poseAt(0.12 * i), step = i > 0 ? between(last, T) : Pose2();
		last = T;
		mrpt::obs::CActionRobotMovement2D movement;
		movement.timestamp = INVALID_TIMESTAMP;
		movement.computeFromOdometry(mrpt::poses::CPose2D(0.97 * step.p.x(), 0.97 * step.p.y(), step.yaw), {});
		mrpt::obs::CActionCollection actions;
		actions.insert(movement);
		std::vector<float> scan;
		for (int k = 0; k < log.beams; ++k) scan.push_back(log.range(T, -M_PI / 2 + M_PI * k / (log.beams - 1)));
		mrpt::obs::CSensoryFrame frame;
		const int64_t t_ns = log.stamp_ns(i);
		frame.insert(std::make_shared<mrpt::obs::CObservation2DRangeScan>(makeScan(t_ns, scan, M_PI, 30, Pose3(), "LIDAR")));
		pairs.insert(actions);
		pairs.insert(frame);
		log.truth.emplace(t_ns, T);
	}
	ASSERT_TRUE(pairs.saveToRawLogFile(folder.file("x.rawlog")));
	const GroundTruthRunResult result = runGroundTruth(optionsFor(folder));
	const RoomErrors e = errorsOf(folder, log);
	std::cout << "[measured] rms " << e.rms_m << " m\n";
	EXPECT_EQ(e.poses, 300u);
	EXPECT_LT(e.rms_m, 0.05);
	EXPECT_NE(readFile(result.summary_path).find("\"guess\": \"odometry\""), std::string::npos);
}

TEST(GroundTruthBadInput, SaysWhatIsWrongInOneLine)
{
	const TempFolder folder;
	expectError([&] { runGroundTruth(optionsFor(folder)); }, {"x.rawlog", "no such file"});
	RoomLog log;
	log.scans = 5;
	log.beams = 1;
	log.write(folder.file("x.rawlog"));
	expectError([&] { runGroundTruth(optionsFor(folder)); }, {"x.rawlog", "no usable scans", "--scan-label"});
	log.beams = 181;
	GroundTruthRunOptions options = optionsFor(folder);
	log.write(folder.file("x.rawlog"));
	options.scan_label = "LASER";
	expectError([&] { runGroundTruth(options); }, {"x.rawlog", "under label LASER", "LIDAR (5 CObservation2DRangeScan)"});
	options.scan_label.clear();
	options.odometry_label = "ODO";
	expectError([&] { runGroundTruth(options); }, {"x.rawlog", "label ODO", "--odometry-label", "ODOMETRY (5 CObservationOdometry)"});
	options.odometry_label.clear();
	options.imu_label = "GYRO";
	expectError([&] { runGroundTruth(options); }, {"x.rawlog", "label GYRO", "--imu-label", "LIDAR (5"});
	options.imu_label.clear();
	for (const double resolution_m : {std::nan(""), std::numeric_limits<double>::infinity(), 0., -1., 1e-9, 1e9})
	{
		options.resolution_m = resolution_m;
		expectError([&] { runGroundTruth(options); }, {"resolution", "0.005 to 1"});
	}
	log.disturb = [](int, std::vector<float>& r, Pose2&) { r.assign(r.size(), 0.f); };
	log.write(folder.file("x.rawlog"));
	expectError([&] { runGroundTruth(optionsFor(folder)); }, {"x.rawlog", "none of the 5 scans"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("out"))) << "a run that fails leaves no folder behind";
}

/** Neither a mixture of two runs nor half of one. */
TEST(GroundTruthBadInput, AFailedRunLeavesTheFolderAsItWas)
{
	const TempFolder folder;
	RoomLog log;
	log.scans = 60;
	log.write(folder.file("x.rawlog"));
	runGroundTruth(optionsFor(folder));
	const auto contents = [&]
	{
		std::map<std::string, std::string> files;
		for (const auto& entry : std::filesystem::directory_iterator(folder.file("out")))
			files[entry.path().filename().string()] = entry.is_directory() ? "folder" : readFile(entry.path().string());
		return files;
	};
	writeFile(folder.file("out/mine.txt"), "left alone");
	auto before = contents();
	EXPECT_EQ(before.size(), 12u);
	RoomLog other;
	other.scans = 80;
	other.write(folder.file("x.rawlog"));
	GroundTruthRunHooks hooks;
	hooks.interrupted = [] { return true; };
	EXPECT_THROW(runGroundTruth(optionsFor(folder), hooks), Error);
	EXPECT_EQ(contents(), before);
	// One of the files has no place: none of the others is written either.
	std::filesystem::remove(folder.file("out/map.png"));
	std::filesystem::create_directory(folder.file("out/map.png"));
	before["map.png"] = "folder";
	expectError([&] { runGroundTruth(optionsFor(folder)); }, {"map.png", "it is a folder"});
	EXPECT_EQ(contents(), before);
	std::filesystem::remove(folder.file("out/map.png"));
	runGroundTruth(optionsFor(folder));
	EXPECT_EQ(contents().size(), 12u);
	EXPECT_NE(contents()["trajectory.tum"], before["trajectory.tum"]);
	EXPECT_EQ(contents()["mine.txt"], "left alone");
}

TEST(GroundTruthBadInput, FewBeamsAreTold)
{
	const TempFolder folder;
	RoomLog log;
	log.scans = 40;
	log.beams = 25;
	log.write(folder.file("x.rawlog"));
	const GroundTruthRunResult result = runGroundTruth(optionsFor(folder));
	ASSERT_FALSE(result.notes.empty());
	EXPECT_NE(result.notes.front().find("40 scans have fewer than 30 beams"), std::string::npos) << result.notes.front();
}
