#include <NormalisedError.h>
#include <SimulatedDrive.h>
#include <gtest/gtest.h>

#include <cmath>

namespace viwo
{
namespace
{
using test::Drive;
using test::DriveResult;
using test::DriveSetup;
using test::errorsOf;
using test::measured;
using test::optionsOf;
using test::runDrive;

constexpr double kHole_s = 6.02, kHoleEnd_s = 9.02;

double positionSigma(const FrameEstimate& e)
{
	return std::sqrt(e.covariance.topLeftCorner<3, 3>().trace());
}

/** Yaw about W's z. */
double yawSigma(const FrameEstimate& e)
{
	const Eigen::Vector3d z_O = e.T_WO.R.conjugate() * Eigen::Vector3d::UnitZ();
	return std::sqrt(z_O.dot(e.covariance.bottomRightCorner<3, 3>() * z_O));
}

/** The last pose before and the first after a time. */
std::pair<FrameEstimate, FrameEstimate> around(const Drive& drive, const DriveResult& result, double begin_s, double end_s)
{
	std::pair<FrameEstimate, FrameEstimate> found;
	for (const FrameEstimate& e : result.estimates)
	{
		if (!e.has_pose) continue;
		if (drive.secondsOf(e.t_ns) < begin_s) found.first = e;
		if (drive.secondsOf(e.t_ns) > end_s && e.status != Status::dead_reckoning && !found.second.has_pose) found.second = e;
	}
	return found;
}

TEST(EstimatorRestart, CovarianceTellsTheErrorsAcrossIt)
{
	for (const Mode mode : {Mode::wio, Mode::viwo})
	{
		double sum = 0, least_position = 1e9, least_yaw = 1e9;
		int count = 0;
		const int runs = test::seedsOf(10);
		for (int seed = 1; seed <= runs; ++seed)
		{
			DriveSetup setup(seed % 2 ? "straight 1 m, rotate 90 deg" : "arc 0.8 m 100 deg", static_cast<uint64_t>(seed));
			test::drawWheels(setup);
			Drive drive(setup);
			drive.silence(drive.imu, kHole_s, kHoleEnd_s);
			const DriveResult result = runDrive(drive, optionsOf(mode));
			EXPECT_EQ(result.counters.reinitializations, 1);
			const auto [before, after] = around(drive, result, kHole_s, kHoleEnd_s);
			ASSERT_TRUE(before.has_pose && after.has_pose);
			least_position = std::min(least_position, positionSigma(after) / positionSigma(before));
			least_yaw = std::min(least_yaw, yawSigma(after) / yawSigma(before));
			const auto [of_run, of_run_count] = test::normalisedErrors(drive, result, kHole_s);
			sum += of_run;
			count += of_run_count;
		}
		const std::string name = ", mode " + modeNames()[static_cast<size_t>(mode)];
		measured("ANEES of position and yaw from the restart on, per degree of freedom, " + std::to_string(runs) + " runs" + name,
		         sum / count, "");
		measured("least growth of the deviation over the hole: position", least_position, "times, yaw " + std::to_string(least_yaw));
		EXPECT_GT(sum / count, 0.3);
		EXPECT_LT(sum / count, 3);
		EXPECT_GE(least_position, 1);
		EXPECT_GE(least_yaw, 1);
	}
}

/** Nothing tells a camera with an IMU how far it went without the IMU. */
TEST(EstimatorRestart, VioKnowsThatItDoesNotKnow)
{
	DriveSetup setup("free 16 s");
	setup.route.speed_m_s = 0.4;
	setup.route.free_speed_amplitudes = {0.5, 0.4};
	setup.route.free_speed_periods_s = {3.0, 1.7};
	setup.route.free_yaw_rate_amplitudes_rad_s = {0.5, 0.3};
	setup.route.free_yaw_rate_periods_s = {5.0, 2.3};
	setup.route.acceleration_m_s2 = 2;
	Drive drive(setup);
	drive.silence(drive.imu, 6.02, 8.02);
	const DriveResult result = runDrive(drive, optionsOf(Mode::vio));
	ASSERT_GE(result.counters.reinitializations, 1);
	const auto [before, after] = around(drive, result, 6.02, 8.02);
	ASSERT_TRUE(before.has_pose && after.has_pose);
	const Pose3 moved = before.T_WO.inverse() * after.T_WO,
	            truly = drive.motion.at_ns(before.t_ns).T_WO.inverse() * drive.motion.at_ns(after.t_ns).T_WO;
	measured("vio over a hole of 2 s: error", (moved.p - truly.p).norm(), "m, deviation " + std::to_string(positionSigma(after)));
	EXPECT_GT(positionSigma(after), 0.5 * (moved.p - truly.p).norm());
	EXPECT_GT(yawSigma(after), 0.5 * std::abs(yawOf(moved.R) - yawOf(truly.R)));
	for (const FrameEstimate& e : result.estimates)
		if (const double t_s = drive.secondsOf(e.t_ns); t_s > 6.2 && t_s < 8)
		{
			EXPECT_FALSE(e.has_pose) << t_s;
			EXPECT_TRUE(e.status == Status::waiting || e.status == Status::initialising) << toString(e.status);
		}
}

/** Poses go on without the IMU, and say what they are. */
TEST(EstimatorRestart, WheelsCarryOnThroughAHoleOfTheImu)
{
	for (const Mode mode : {Mode::wio, Mode::viwo})
		for (const double hole_s : {0.6, 3.0})
		{
			Drive drive(DriveSetup("straight 0.6 m, arc 0.8 m 90 deg"));
			const double clean_m = errorsOf(drive, runDrive(drive, optionsOf(mode))).ate_xyz_m;
			drive.silence(drive.imu, kHole_s, kHole_s + hole_s);
			const DriveResult result = runDrive(drive, optionsOf(mode));
			const double ate_m = errorsOf(drive, result).ate_xyz_m;
			int reckoned = 0;
			double last_sigma_m = 0;
			for (const FrameEstimate& e : result.estimates)
			{
				const double t_s = drive.secondsOf(e.t_ns);
				EXPECT_TRUE(e.has_pose || t_s < 1) << t_s;
				// A frame waits 0.3 s for the IMU: the last ones see it come back.
				if (t_s < kHole_s + 0.2 || t_s > kHole_s + hole_s - 0.3) continue;
				++reckoned;
				EXPECT_EQ(e.status, Status::dead_reckoning) << t_s;
				EXPECT_GE(positionSigma(e), last_sigma_m) << t_s;
				last_sigma_m = positionSigma(e);
			}
			measured(modeNames()[static_cast<size_t>(mode)] + ", IMU away for " + std::to_string(hole_s) + " s: poses from the wheels",
			         reckoned, "");
			measured("  ATE", 1e3 * ate_m,
			         "mm, clean " + std::to_string(1e3 * clean_m) + "; largest step " + std::to_string(1e3 * result.largestStep_m()));
			EXPECT_GE(reckoned, static_cast<int>(10 * hole_s) - 5);
			EXPECT_LT(ate_m, 2 * clean_m + 0.01);
			EXPECT_LT(result.largestStep_m(), 0.05);
			EXPECT_EQ(result.status, mode == Mode::wio ? Status::from_wheels : Status::tracking);
			EXPECT_EQ(result.counters.reinitializations, hole_s > 1 ? 1 : 0);
			EXPECT_EQ(result.counters.imu_gaps, 1);
			EXPECT_EQ(result.counters.wheel_gaps, 0);
		}
}

/** What was found of wheels, camera and biases is there after a hole. */
TEST(EstimatorRestart, CalibrationAndBiasesOutlastAHole)
{
	DriveSetup setup("straight 1.2 m, rotate 90 deg, straight 0.6 m");
	Drive drive(setup);
	const double begin_s = 9.02, end_s = 11.5;
	drive.silence(drive.imu, begin_s, end_s);
	CalibrationEstimate before, at_loss, after;
	NavState state_before, state_after;
	bool lost = false, found_again = false;
	const auto look = [&](const Estimator& estimator, const FrameEstimate& e)
	{
		const double t_s = drive.secondsOf(e.t_ns);
		if (t_s < begin_s) before = estimator.calibration(), state_before = e.state;
		if (!lost && estimator.counters().reinitializations > 0) lost = true, at_loss = estimator.calibration();
		if (!lost || found_again || e.status == Status::dead_reckoning) return;
		found_again = true;
		after = estimator.calibration(), state_after = e.state;
	};
	runDrive(drive, optionsOf(Mode::viwo), look);
	ASSERT_TRUE(lost && found_again);
	const auto difference = [](const CalibrationEstimate& c) { return c.wheels.k_right - c.wheels.k_left; };
	measured("difference of the wheels before a hole", 1e3 * difference(before),
	         "per mille, in it " + std::to_string(1e3 * difference(at_loss)) + ", after it " + std::to_string(1e3 * difference(after)));
	measured("change of the gyro bias", 1e3 * (state_after.b_g - state_before.b_g).norm(),
	         "mrad/s; of the accelerometer's " + std::to_string((state_after.b_a - state_before.b_a).norm()) + " m/s^2");
	EXPECT_GT(std::abs(difference(before)), 1e-3);
	EXPECT_EQ(at_loss.wheels.k_left, before.wheels.k_left);
	EXPECT_EQ(at_loss.wheels.k_right, before.wheels.k_right);
	EXPECT_EQ(at_loss.wheels.track_m, before.wheels.track_m);
	EXPECT_EQ(at_loss.T_BC.p, before.T_BC.p);
	EXPECT_NEAR(difference(after), difference(before), 5e-4);
	EXPECT_LT((state_after.b_g - state_before.b_g).norm(), 1e-3);
	EXPECT_LT((state_after.b_a - state_before.b_a).norm(), 0.03);
}

/** A blow that no robot survives: what the window says of biases and calibration is not believed any more, where it was is. */
TEST(EstimatorRestart, AfterADivergenceFromNominalValues)
{
	Drive drive(DriveSetup("straight 1.5 m"));
	for (ImuSample& s : drive.imu)
		if (const double t_s = drive.secondsOf(s.t_ns); t_s > 6 && t_s < 6.3) s.acc_m_s2 += Eigen::Vector3d(3e4, -2e4, 1e4);
	WheelIntrinsics right_after;
	bool lost = false;
	const DriveResult result = runDrive(drive, optionsOf(Mode::viwo),
	                                    [&](const Estimator& estimator, const FrameEstimate&)
	                                    {
		                                    if (!lost && estimator.counters().reinitializations > 0)
			                                    right_after = estimator.calibration().wheels;
		                                    lost = estimator.counters().reinitializations > 0;
	                                    });
	ASSERT_TRUE(lost);
	EXPECT_EQ(right_after.k_left, 1);
	EXPECT_EQ(right_after.track_m, drive.calibration.wheels.track_m);
	const TrajectoryErrors errors = errorsOf(drive, result);
	measured("ATE over a divergence", 1e3 * errors.ate_xyz_m, "mm, largest step " + std::to_string(1e3 * result.largestStep_m()));
	EXPECT_TRUE(result.finite());
	EXPECT_LT(errors.ate_xyz_m, 0.05);
	EXPECT_EQ(result.status, Status::tracking);
	const auto [before, after] = around(drive, result, 6, 6.5);
	EXPECT_GE(positionSigma(after), positionSigma(before));
	EXPECT_GE(yawSigma(after), yawSigma(before));
}

/** A start that cannot be solved is none: nothing was lost, nothing is counted, and nothing is kept that the next attempt does not need. */
TEST(EstimatorRestart, AFailedFirstStartIsNoRestart)
{
	Drive drive(DriveSetup("straight 1 m"));
	for (ImuSample& s : drive.imu)
		if (drive.secondsOf(s.t_ns) < 3) s.acc_m_s2 += Eigen::Vector3d(3e4, 0, 0) * std::sin(40 * drive.secondsOf(s.t_ns));
	const DriveResult result = runDrive(drive, optionsOf(Mode::wio));
	measured("first pose of a robot that is shaken for 3 s", result.first_pose_s, "s");
	EXPECT_GT(result.first_pose_s, 2.5);
	EXPECT_EQ(result.counters.reinitializations, 0);
	EXPECT_EQ(result.status, Status::from_wheels);
	EXPECT_EQ(result.changes.size(), 2u) << "waiting, initialising, from_wheels";
}

TEST(EstimatorRestart, EachHoleIsCountedOnce)
{
	for (const Mode mode : {Mode::wheel, Mode::wio, Mode::viwo})
	{
		Drive drive(DriveSetup("arc 1 m 120 deg"));
		drive.silence(drive.wheels, 4, 6);
		drive.silence(drive.wheels, 8, 9);
		if (mode != Mode::wheel) drive.silence(drive.imu, 10.02, 12.5);
		const DriveResult result = runDrive(drive, optionsOf(mode));
		EXPECT_EQ(result.counters.wheel_gaps, 2);
		EXPECT_EQ(result.counters.imu_gaps, mode == Mode::wheel ? 0 : 1);
	}
}
}  // namespace
}  // namespace viwo
