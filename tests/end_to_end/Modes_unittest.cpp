#include <algorithm>
#include <cstdio>

#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
/** Short logs of one seed: margins are wider than the bars of viwo_accuracy. */
class Modes : public OdometryProgram
{
   protected:
	/** Runs a mode; prints its errors. */
	TrajectoryErrors measure(const TestLog& log, const std::string& mode)
	{
		odometry(log.rawlog, mode, {"--mode", mode, "--quiet"});
		if (HasFatalFailure()) return {};
		const TrajectoryErrors e = errors(mode, log.ground_truth);
		const double covered = e.coverage;
		std::printf("[measured] %s: ATE %.2f cm of %.2f m, yaw %.2f deg, coverage %.3f, first pose after %.2f s\n", mode.c_str(),
		            100 * e.ate_xyz_m, e.length_m, e.yaw_rmse_deg, covered, summary(mode).at("first_pose_s").get<double>());
		return e;
	}
};

TEST_F(Modes, CorridorWithTurnsOnTheSpot)
{
	const TestLog log = testLog(corridorTestDrive());
	const TrajectoryErrors wheel = measure(log, "wheel"), wio = measure(log, "wio"), viwo = measure(log, "viwo");
	EXPECT_LT(wheel.ate_xyz_m, 0.10);
	EXPECT_LT(wio.ate_xyz_m, 0.05);
	EXPECT_LT(viwo.ate_xyz_m, 0.025);
	EXPECT_LT(viwo.ate_xyz_m, wheel.ate_xyz_m + 0.01);
	EXPECT_GE(viwo.coverage, 0.95) << "of 24 s one may pass before the first pose";
	const Json s = summary("viwo");
	EXPECT_EQ(s.at("status"), "tracking");
	EXPECT_EQ(s.at("slip_events"), 0);
	EXPECT_EQ(s.at("reinitializations"), 0);
	EXPECT_LE(s.at("first_pose_s").get<double>(), 1.0);
}

TEST_F(Modes, LobbyOnAnArcInMotionFromTheStart)
{
	const TestLog log = testLog(lobbyTestDrive());
	const TrajectoryErrors wheel = measure(log, "wheel"), vio = measure(log, "vio"), viwo = measure(log, "viwo");
	EXPECT_LT(viwo.ate_xyz_m, 0.025);
	EXPECT_LT(viwo.yaw_rmse_deg, 0.5);
	EXPECT_LT(viwo.ate_xyz_m, wheel.ate_xyz_m + 0.01);
	// On a constant arc camera and IMU observe no scale (Wu et al. 2017): vio is only to stay bounded, and viwo to beat it.
	EXPECT_LT(vio.ate_xyz_m, 0.25) << "has diverged";
	EXPECT_LT(viwo.ate_xyz_m, vio.ate_xyz_m);
	EXPECT_GE(viwo.coverage, 0.94) << "of 20 s one may pass before the first pose";
	EXPECT_LE(summary("viwo").at("first_pose_s").get<double>(), 1.0);
}

TEST_F(Modes, EvaluationProgramAgrees)
{
	const TestLog log = testLog(corridorTestDrive());
	const TrajectoryErrors wheel = measure(log, "wheel");
	const ProgramResult table = runProgram(program("viwo-evaluate"), {"-r", log.ground_truth, "-e", output("wheel", "trajectory.tum"),
	                                                                  "--json", folder_.file("errors.json"), "--max-ate", "0.5"});
	ASSERT_EQ(table.status, 0) << table.err;
	const Json j = loadJson(folder_.file("errors.json"));
	EXPECT_NEAR(j.at("ate_xyz_m").get<double>(), wheel.ate_xyz_m, 1e-8);
	for (const char* key : {"ate_xy_m", "ate_z_m", "rpe_trans_percent", "yaw_rmse_deg", "length_m", "matched", "coverage"})
		EXPECT_TRUE(j.contains(key)) << key;
	const ProgramResult over = runProgram(
	    program("viwo-evaluate"), {"-r", log.ground_truth, "-e", output("wheel", "trajectory.tum"), "--max-ate", "0.0001", "--quiet"});
	EXPECT_EQ(over.status, 1);
	EXPECT_EQ(over.errorLines(), 1u) << over.err;
}
}  // namespace
}  // namespace viwo::testing
