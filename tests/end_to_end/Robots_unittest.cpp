#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
/** Other robots than that of the defaults, by configuration alone; viwo_accuracy measures more of them, on longer drives. */
class Robots : public OdometryProgram
{
   protected:
	std::string config(const std::string& text) const { return write(folder_, "robot.ini", text); }

	void expectAccurate(const std::string& name, const std::string& ground_truth, const std::string& what) const
	{
		const TrajectoryErrors e = errors(name, ground_truth);
		const double percent = 100 * e.ate_xyz_m / e.length_m;
		std::cout << "[measured] " << what << ": ATE " << 100 * e.ate_xyz_m << " cm of " << e.length_m << " m, " << percent << " %\n";
		EXPECT_LT(percent, 1.5) << what;
		EXPECT_GT(e.coverage, 0.85) << what << ": all but the first second";
	}
};

TEST_F(Robots, CameraToTheSideImuOnItsSide)
{
	const TestLog log = testLog(sidewaysRobotDrive());
	const std::string ini =
	    config("[rawlog]\ncam_label = left_camera\nimu_label = xsens\nodometry_label = base\nodometry_source = ticks_absolute\n");
	odometry(log.rawlog, "out", {"-c", ini, "--quiet"});
	expectAccurate("out", log.ground_truth, "small colour camera to the left, IMU on its side, ticks");
}

TEST_F(Robots, FisheyeBackwardsAndEverythingSlow)
{
	const TestLog log = testLog(backwardsRobotDrive());
	odometry(log.rawlog, "out", {"--quiet"});
	expectAccurate("out", log.ground_truth, "fisheye backwards at 5 Hz, IMU 50 Hz, wheels 5 Hz");
}

TEST_F(Robots, FourWheelsAsJointsOfABag)
{
	const std::string to_bag = program("viwo_rawlog_to_bag");
	if (!std::filesystem::exists(to_bag)) GTEST_SKIP() << "built without ROS bags";
	const std::string bag = folder_.file("x.bag"), rawlog = folder_.file("x.rawlog");
	const ProgramResult recorded = runProgram(to_bag, {VIWO_SOURCE_DIR "/rawlogs/sample.rawlog", "-o", bag, "--four-wheels"});
	ASSERT_EQ(recorded.status, 0) << recorded.err;
	const std::string map = write(folder_, "map.ini", recorded.out);
	const ProgramResult imported = runProgram(program("viwo-import"), {"rosbag", bag, "-o", rawlog, "--map", map, "--quiet"});
	ASSERT_EQ(imported.status, 0) << imported.err;
	odometry(rawlog, "out", {"--quiet"});
	expectAccurate("out", VIWO_SOURCE_DIR "/rawlogs/sample_ground_truth.tum", "four wheels as joints of a bag");
}
}  // namespace
}  // namespace viwo::testing
