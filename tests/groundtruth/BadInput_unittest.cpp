#include "ExpectError.h"
#include "RoomRun.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <filesystem>
#include <iostream>

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

std::vector<Case> badSensors()
{
	const float nan = std::numeric_limits<float>::quiet_NaN();
	return {
	    {"odometry jumps", 0.05, "odometry jumped 1 times against the scans, by up to 0.5", 0, 0,
	     [](RoomLog& log)
	     {
		     log.disturb = [](int i, std::vector<float>&, Pose2& odometry)
		     {
			     if (i == 200) odometry = odometry * Pose2(0.5, 0, 30 * M_PI / 180);
		     };
	     }},
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
}  // namespace

TEST(GroundTruthBadInput, IsSurvivedFlaggedAndTold)
{
	for (const Case& c : badSensors())
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
	log.disturb = [](int, std::vector<float>& r, Pose2&) { r.assign(r.size(), 0.f); };
	log.write(folder.file("x.rawlog"));
	expectError([&] { runGroundTruth(optionsFor(folder)); }, {"x.rawlog", "none of the 5 scans"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("out/trajectory.tum")));
}
