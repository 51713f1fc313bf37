#include <viwo/core/So3.h>
#include <viwo/estimator/Estimator.h>

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

const std::string kCorridor = "straight 1 m, rotate 120 deg, straight 1 m";
const std::string kArc = "arc 1 m 180 deg";

TEST(Estimator, ExactReadingsGiveTheExactTrajectory)
{
	for (const Mode mode : {Mode::wheel, Mode::wio, Mode::viwo})
		for (const std::string& route : {std::string("straight 0.6 m, rotate 60 deg, arc 0.8 m 60 deg")})
		{
			const Drive drive(DriveSetup::perfect(route));
			const DriveResult result = runDrive(drive, optionsOf(mode));
			const TrajectoryErrors errors = errorsOf(drive, result);
			measured("ATE of exact readings, mode " + modeNames()[static_cast<size_t>(mode)], 1e3 * errors.ate_xyz_m, "mm");
			EXPECT_TRUE(result.finite());
			EXPECT_LT(errors.ate_xyz_m, 1e-3);
			EXPECT_EQ(result.counters.slip_events, 0);
			EXPECT_EQ(result.counters.reinitializations, 0);
		}
}

TEST(Estimator, CorridorAndArc)
{
	for (const std::string& route : {kCorridor, kArc})
	{
		double worst_percent = 0;
		for (int seed = 1; seed <= test::seedsOf(2); ++seed)
		{
			const Drive drive(DriveSetup(route, seed));
			const DriveResult result = runDrive(drive, optionsOf(Mode::viwo));
			const TrajectoryErrors errors = errorsOf(drive, result);
			worst_percent = std::max(worst_percent, 100 * errors.ate_xyz_m / errors.length_m);
			measured("ATE viwo", 1e3 * errors.ate_xyz_m, "mm of " + std::to_string(errors.length_m) + " m, " + route);
			EXPECT_EQ(result.counters.slip_events, 0);
			EXPECT_EQ(result.counters.reinitializations, 0);
			EXPECT_EQ(result.status, Status::tracking);
			EXPECT_GT(errors.coverage, 0.9);
		}
		EXPECT_LT(worst_percent, 1.5) << route;
	}
}

TEST(Estimator, VioOnALivelyMotionIsMetric)
{
	DriveSetup setup("free 25 s");
	setup.route.speed_m_s = 0.4;
	setup.route.free_speed_amplitudes = {0.5, 0.4};
	setup.route.free_speed_periods_s = {3.0, 1.7};
	setup.route.free_yaw_rate_amplitudes_rad_s = {0.5, 0.3};
	setup.route.free_yaw_rate_periods_s = {5.0, 2.3};
	setup.route.acceleration_m_s2 = 2;
	setup.tracks.max_features = 100;
	const Drive drive(setup);
	const DriveResult result = runDrive(drive, optionsOf(Mode::vio));
	ASSERT_GT(result.trajectory.size(), 100u);
	const TrajectoryErrors errors = errorsOf(drive, result);
	measured("ATE vio", 1e3 * errors.ate_xyz_m, "mm of " + std::to_string(errors.length_m) + " m");
	measured("first pose", result.first_pose_s, "s");
	EXPECT_TRUE(result.finite());
	EXPECT_LT(errors.ate_xyz_m, 0.05 * errors.length_m);
	EXPECT_EQ(result.counters.reinitializations, 0);
}

TEST(Estimator, BlackCameraIsDeadReckonedAndTakenUpAgain)
{
	Drive drive(DriveSetup("arc 1 m 120 deg"));
	const double clean_m = errorsOf(drive, runDrive(drive, optionsOf(Mode::viwo))).ate_xyz_m;
	drive.blacken(7, 12);
	const DriveResult result = runDrive(drive, optionsOf(Mode::viwo));
	const TrajectoryErrors errors = errorsOf(drive, result);
	measured("ATE with a camera black for 5 s", 1e3 * errors.ate_xyz_m, "mm; clean: " + std::to_string(1e3 * clean_m));
	EXPECT_TRUE(result.finite());
	EXPECT_LT(errors.ate_xyz_m, 2 * clean_m + 0.01);
	EXPECT_EQ(result.counters.reinitializations, 0);
	EXPECT_EQ(result.status, Status::tracking);
	bool was_dead_reckoning = false;
	for (const StatusChange& c : result.changes) was_dead_reckoning = was_dead_reckoning || c.to == Status::dead_reckoning;
	EXPECT_TRUE(was_dead_reckoning);
}

TEST(Estimator, SilentWheels)
{
	DriveSetup setup("arc 1 m 120 deg");
	const double clean_m = errorsOf(Drive(setup), runDrive(setup, optionsOf(Mode::viwo))).ate_xyz_m;
	setup.wheels.silences = {7, 5};
	const Drive drive(setup);
	for (const Mode mode : {Mode::viwo, Mode::wio})
	{
		const DriveResult result = runDrive(drive, optionsOf(mode));
		const TrajectoryErrors errors = errorsOf(drive, result);
		measured("ATE with wheels silent for 5 s, mode " + modeNames()[static_cast<size_t>(mode)], 1e3 * errors.ate_xyz_m, "mm");
		EXPECT_TRUE(result.finite());
		EXPECT_EQ(result.counters.reinitializations, 0);
		EXPECT_EQ(result.counters.slip_events, 0);
		EXPECT_GT(result.counters.wheel_gaps, 0);
		EXPECT_LT(errors.ate_xyz_m, mode == Mode::viwo ? 2 * clean_m + 0.01 : 0.5);
	}
}

TEST(Estimator, HolesInTheImuStream)
{
	for (const double hole_s : {0.05, 0.5, 3.0})
	{
		Drive drive(DriveSetup("arc 1 m 120 deg"));
		drive.silence(drive.imu, 7.02, 7.02 + hole_s);
		const DriveResult result = runDrive(drive, optionsOf(Mode::viwo));
		const TrajectoryErrors errors = errorsOf(drive, result);
		const std::string what = "IMU hole of " + std::to_string(hole_s) + " s: ";
		measured(what + "ATE", 1e3 * errors.ate_xyz_m, "mm");
		measured(what + "largest step", 1e3 * result.largestStep_m(), "mm");
		measured(what + "frames without pose", static_cast<double>(result.frames_without_pose), "");
		EXPECT_TRUE(result.finite());
		EXPECT_EQ(result.counters.reinitializations, hole_s > 1 ? 1 : 0);
		EXPECT_LT(errors.ate_xyz_m, 0.05);
		EXPECT_LT(result.largestStep_m(), 0.05 + 0.2 * (hole_s + 1));
		EXPECT_EQ(result.status, Status::tracking);
	}
}

TEST(Estimator, WithoutImuThereIsNoPoseAndNoHarm)
{
	Drive drive(DriveSetup("straight 0.5 m"));
	drive.imu.clear();
	for (const Mode mode : {Mode::wio, Mode::vio, Mode::viwo})
	{
		const DriveResult result = runDrive(drive, optionsOf(mode));
		EXPECT_TRUE(result.trajectory.empty());
		EXPECT_EQ(result.counters.reinitializations, 0);
		EXPECT_NE(result.status, Status::tracking);
	}
}

TEST(Estimator, WithoutWheelsVisionStarts)
{
	DriveSetup setup("free 12 s");
	setup.route.speed_m_s = 0.4;
	setup.route.free_speed_amplitudes = {0.5, 0.4};
	setup.route.free_speed_periods_s = {3.0, 1.7};
	setup.route.acceleration_m_s2 = 2;
	Drive drive(setup);
	drive.wheels.clear();
	EXPECT_TRUE(runDrive(drive, optionsOf(Mode::wheel)).trajectory.empty());
	EXPECT_TRUE(runDrive(drive, optionsOf(Mode::wio)).trajectory.empty());
	const DriveResult result = runDrive(drive, optionsOf(Mode::viwo));
	EXPECT_GT(result.trajectory.size(), 50u);
	EXPECT_TRUE(result.finite());
}

/** On a constant arc vision and IMU do not observe the scale; but the wheel factors of the window will. */
TEST(Estimator, VisionStartsOnAConstantArcWhenWheelsFollow)
{
	EstimatorOptions options = optionsOf(Mode::viwo);
	options.factors.wheels_in_initialization = false;
	for (int seed = 1; seed <= 2; ++seed)
	{
		const Drive drive(DriveSetup(kArc, seed));
		const DriveResult result = runDrive(drive, options);
		ASSERT_GT(result.trajectory.size(), 50u);
		const TrajectoryErrors errors = errorsOf(drive, result);
		measured("first pose", result.first_pose_s, "s; ATE " + std::to_string(1e3 * errors.ate_xyz_m) + " mm");
		EXPECT_LT(result.first_pose_s, 5);
		EXPECT_LT(errors.ate_xyz_m, 0.015 * errors.length_m);
		EXPECT_EQ(result.counters.reinitializations, 0);
	}
}

/** Wheels that are not what is published, and a camera that sits elsewhere: what the estimator finds is nearer to the truth. */
TEST(Estimator, FindsWheelsAndCameraPose)
{
	DriveSetup setup("straight 1 m, arc 1 m 120 deg, rotate -90 deg, straight 1 m, arc 1 m -90 deg");
	setup.wheels.radius_error = 0;
	setup.wheels.left_right_difference = 0.012;
	setup.wheels.track_error = 0.02;
	Drive drive(setup);
	const Pose3 T_BC_true = drive.calibration.T_BC();
	const Eigen::Quaterniond turn = so3::expQuaternion(Eigen::Vector3d(0.006, -0.008, 0.007));
	drive.calibration.T_OC.R = (drive.calibration.T_OC.R * turn).normalized();
	const DriveResult result = runDrive(drive, optionsOf(Mode::viwo));
	const WheelIntrinsics& wheels = result.calibration.wheels;
	const double ratio_error = std::abs(wheels.k_right / wheels.k_left - 1.012);
	// Turns tell the track against the size of the wheels, and that is known from the priors alone.
	const double k = 0.5 * (wheels.k_left + wheels.k_right), track_error = std::abs(wheels.track_m / 0.23 / k - 1.02 / 1.006);
	const double camera_rad = so3::log(T_BC_true.R.conjugate() * result.calibration.T_BC.R).norm(), start_rad = so3::log(turn).norm();
	measured("right over left radius, error", 100 * ratio_error, "% (1.2 at the start)");
	measured("track against the wheels, error", 100 * track_error, "% (1.4 at the start)");
	measured("rotation of T_BC, error", 1e3 * camera_rad, "mrad (" + std::to_string(1e3 * start_rad) + " at the start)");
	EXPECT_LT(ratio_error, 0.25 * 0.012);
	EXPECT_LT(track_error, 0.5 * 0.014);
	EXPECT_LT(camera_rad, 0.5 * start_rad);
}

/** Gravity is configuration: at the equator and on a mountain it is another. */
TEST(Estimator, GravityIsThatOfTheConfiguration)
{
	DriveSetup setup("straight 1 m, arc 1 m 60 deg");
	setup.imu.gravity_m_s2 = 9.76;
	const Drive drive(setup);
	EstimatorOptions options = optionsOf(Mode::viwo);
	options.noise.gravity_m_s2 = 9.76;
	const DriveResult result = runDrive(drive, options);
	const TrajectoryErrors errors = errorsOf(drive, result);
	measured("ATE at 9.76 m/s^2", 1e3 * errors.ate_xyz_m, "mm");
	EXPECT_LT(errors.ate_xyz_m, 0.03);
	EXPECT_EQ(result.counters.reinitializations, 0);
}

/** A base whose first reading comes after the first image. */
TEST(Estimator, WheelsThatBeginLaterDoNotDelayTheStart)
{
	for (const std::string& route : {std::string("stand 6 s"), std::string("straight 1 m")})
	{
		DriveSetup setup(route);
		setup.wheels.phase_ms = 45;
		const Drive drive(setup);
		for (const Mode mode : {Mode::wheel, Mode::wio, Mode::viwo})
		{
			const DriveResult result = runDrive(drive, optionsOf(mode));
			measured("first pose, mode " + modeNames()[static_cast<size_t>(mode)] + ", " + route, result.first_pose_s, "s");
			EXPECT_LE(result.first_pose_s, 1.0) << route;
			EXPECT_GE(result.first_pose_s, 0) << route;
		}
	}
}

TEST(Estimator, FramesOutOfOrderAreIgnored)
{
	for (const Mode mode : {Mode::wheel, Mode::viwo})
	{
		const Drive drive(DriveSetup("straight 0.6 m"));
		const DriveResult clean = runDrive(drive, optionsOf(mode));
		Drive disturbed(DriveSetup("straight 0.6 m"));
		std::vector<FeatureFrame> frames;
		for (size_t i = 0; i < drive.frames.size(); ++i)
		{
			frames.push_back(drive.frames[i]);
			if (i % 7 == 3) frames.push_back(drive.frames[i]);
			if (i % 7 == 5)
			{
				frames.push_back(drive.frames[i]);
				frames.back().t_ns -= 20'000'000;
			}
			if (i % 7 == 6) frames.push_back(drive.frames[i - 1]);
		}
		disturbed.frames = frames;
		const DriveResult result = runDrive(disturbed, optionsOf(mode));
		EXPECT_EQ(result.counters.reinitializations, 0);
		ASSERT_EQ(result.trajectory.size(), clean.trajectory.size());
		for (size_t i = 0; i < clean.trajectory.size(); ++i)
			EXPECT_EQ(result.trajectory.poses()[i].T.p, clean.trajectory.poses()[i].T.p) << "pose " << i;
	}
}

TEST(Estimator, EverySwitchRuns)
{
	const Drive drive(DriveSetup("straight 0.6 m, rotate 20 deg"));
	using Switch = std::pair<std::string, std::function<void(FactorOptions&)>>;
	const std::vector<Switch> switches{{"wheel_factor off", [](FactorOptions& f) { f.wheel_factor = false; }},
	                                   {"plane_factor off", [](FactorOptions& f) { f.plane_factor = false; }},
	                                   {"plane_pairwise", [](FactorOptions& f) { f.plane_pairwise = true; }},
	                                   {"wheels_in_initialization off", [](FactorOptions& f) { f.wheels_in_initialization = false; }},
	                                   {"slip_gate off", [](FactorOptions& f) { f.slip_gate = false; }},
	                                   {"standstill_factor off", [](FactorOptions& f) { f.standstill_factor = false; }},
	                                   {"estimate_wheel_intrinsics off", [](FactorOptions& f) { f.estimate_wheel_intrinsics = false; }},
	                                   {"estimate_T_BC off", [](FactorOptions& f) { f.estimate_T_BC = false; }}};
	for (const auto& [name, apply] : switches)
	{
		EstimatorOptions options = optionsOf(Mode::viwo);
		apply(options.factors);
		const DriveResult result = runDrive(drive, options);
		EXPECT_TRUE(result.finite()) << name;
		EXPECT_EQ(result.counters.reinitializations, 0) << name;
		ASSERT_GT(result.trajectory.size(), 10u) << name;
		const TrajectoryErrors errors = errorsOf(drive, result);
		measured("ATE, " + name, 1e3 * errors.ate_xyz_m,
		         "mm of " + std::to_string(errors.length_m) + " m; first pose " + std::to_string(result.first_pose_s) + " s");
		EXPECT_LT(errors.ate_xyz_m, 0.1) << name;
	}
}

/** A floor with waves of some metres: the robot drives over slopes of several degrees. */
TEST(Estimator, SlopesDoNotLiftTheEstimate)
{
	DriveSetup setup("straight 3 m");
	setup.route.speed_m_s = 0.3;
	setup.floor.height_rms_mm = 40;
	setup.floor.wavelength_min_m = 3.5;
	setup.floor.wavelength_max_m = 4;
	const Drive drive(setup);
	double steepest_deg = 0;
	const Trajectory truth = drive.motion.groundTruth(10);
	for (const StampedPose& p : truth.poses())
		steepest_deg = std::max(steepest_deg, std::acos(std::min(1.0, p.T.R.toRotationMatrix()(2, 2))) * 180 / M_PI);
	for (const Mode mode : {Mode::wio, Mode::viwo})
	{
		const DriveResult result = runDrive(drive, optionsOf(mode));
		const TrajectoryErrors errors = errorsOf(drive, result);
		measured("slope up to " + std::to_string(steepest_deg) + " deg, mode " + modeNames()[static_cast<size_t>(mode)] + ": ATE z",
		         1e3 * errors.ate_z_m, "mm, xy " + std::to_string(1e3 * errors.ate_xy_m));
		EXPECT_TRUE(result.finite());
		EXPECT_LT(errors.ate_z_m, 0.1);
		EXPECT_EQ(result.counters.reinitializations, 0);
	}
	EXPECT_GT(steepest_deg, 3);
}

TEST(Estimator, SameReadingsSameNumbers)
{
	const Drive drive(DriveSetup("straight 0.5 m, rotate 40 deg"));
	const DriveResult one = runDrive(drive, optionsOf(Mode::viwo)), two = runDrive(drive, optionsOf(Mode::viwo));
	ASSERT_EQ(one.estimates.size(), two.estimates.size());
	for (size_t i = 0; i < one.estimates.size(); ++i)
	{
		EXPECT_EQ(one.estimates[i].T_WO.p, two.estimates[i].T_WO.p);
		EXPECT_EQ(one.estimates[i].T_WO.R.coeffs(), two.estimates[i].T_WO.R.coeffs());
		EXPECT_EQ(one.estimates[i].covariance, two.estimates[i].covariance);
		EXPECT_EQ(one.estimates[i].landmarks, two.estimates[i].landmarks);
	}
}
}  // namespace
}  // namespace viwo
