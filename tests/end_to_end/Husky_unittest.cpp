#include <viwo/core/Time.h>

#include <cmath>
#include <cstdlib>

#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
class Husky : public OdometryProgram
{
};

/** A skid-steered robot outdoors, without a camera: from its bag to a trajectory, against GPS. */
TEST_F(Husky, WheelsAndImuOfABagFollowGps)
{
	const char* data = std::getenv("VIWO_TEST_DATA");
	if (!data) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	const std::string bag = std::string(data) + "/husky/test1.bag", rawlog = folder_.file("husky.rawlog");
	if (!std::filesystem::exists(bag)) GTEST_SKIP() << "no " << bag;
	const ProgramResult imported = runProgram(program("viwo-import"), {"rosbag", bag, "-o", rawlog});
	if (imported.err.find("built without ROS bags") != std::string::npos) GTEST_SKIP() << imported.err;
	ASSERT_EQ(imported.status, 0) << imported.err;

	odometry(rawlog, "wio", {"--mode", "wio", "-c", VIWO_SOURCE_DIR "/share/viwo/config_files/viwo-odometry/husky.ini"});
	EvaluationOptions in_the_plane;
	in_the_plane.alignment = AlignmentKind::yaw;
	const TrajectoryErrors e = evaluate(Trajectory::loadTum(folder_.file("husky_gps.tum")), trajectory("wio"), in_the_plane);
	std::cout << "[measured] ATE x-y against GPS " << e.ate_xy_m << " m over " << summary("wio").at("path_length_m") << " m, coverage "
	          << summary("wio").at("coverage") << "\n";
	EXPECT_LE(e.ate_xy_m, 3.5) << "dead reckoning with the gyroscope has 3.0 m, the robot's own odometry 7.0 m";
	EXPECT_GT(summary("wio").at("coverage").get<double>(), 0.99);
	EXPECT_NEAR(summary("wio").at("path_length_m").get<double>(), 359, 4);
}
}  // namespace
}  // namespace viwo::testing
