#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>

#include <SimulatedDrive.h>
#include <gtest/gtest.h>
#include <residuals/BlockAlgebra.h>

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

/** Starts, stops and turns both ways. */
const std::string kLively =
    "2 x (straight 0.6 m, rotate 100 deg, stand 1 s, arc 0.5 m 90 deg, straight 0.4 m, rotate -120 deg, arc 0.4 m -80 deg)";

DriveSetup lively(uint64_t seed, const std::string& segments = kLively)
{
	DriveSetup setup(segments, seed);
	setup.route.speed_m_s = 0.4;
	setup.route.yaw_rate_rad_s = 0.6;
	setup.route.acceleration_m_s2 = 0.6;
	setup.route.yaw_acceleration_rad_s2 = 1.2;
	setup.tracks.max_features = 40;
	return setup;
}

/** What a rig with a ruler's calibration has wrong: 2 cm and 1 deg at wheels and camera, 20 ms at each clock, wheels by 2 and 3 %. */
struct WrongStart
{
	explicit WrongStart(DriveSetup setup)
	{
		setup.wheels.radius_error = 0.02;
		setup.wheels.left_right_difference = 0;
		setup.wheels.track_error = 0.03;
		setup.wheels.clock_offset_ms = kOffset_w_s * 1e3;
		setup.tracks.clock_offset_s = kOffset_d_s;
		setup.imu.pose_error = {0.014, 0, -0.014, 0, 1, 0};  // B's axes are a camera's: x right, y down
		drive.emplace(setup);
		T_BO = drive->imu_model.T_OB_actual().inverse();
		T_BC = T_BO * drive->calibration.T_OC;
		const Pose3 error(so3::expQuaternion(Eigen::Vector3d(0.6, -0.6, 0.5) * kDegree), Eigen::Vector3d(0.01, -0.01, 0.01));
		drive->calibration.T_OC = drive->calibration.T_OC * error;
	}

	static constexpr double kOffset_d_s = 0.02, kOffset_w_s = -0.02;
	std::optional<Drive> drive;
	Pose3 T_BO, T_BC;  //!< true
};

EstimatorOptions uncalibrated()
{
	EstimatorOptions o = optionsOf(Mode::viwo);
	o.factors.estimate_wheel_intrinsics = o.factors.estimate_T_BC = false;
	return o;
}

EstimatorOptions calibrating(Mode mode = Mode::viwo)
{
	EstimatorOptions o = optionsOf(mode);
	o.factors.estimate_T_BO = o.factors.estimate_camera_time_offset = o.factors.estimate_wheel_time_offset = true;
	return o;
}

/** With deviations for what a WrongStart has wrong. */
EstimatorOptions doubting()
{
	EstimatorOptions o = calibrating();
	o.priors.wheel_scale = 0.02;
	o.priors.track_relative = 0.03;
	o.priors.T_BC_translation_m = 0.02;
	return o;
}

/** Prints an error beside the deviation that is said of it. @return whether it is within three. */
int outside(const std::string& what, double error, double deviation)
{
	std::cout << "[measured] " << what << ": off by " << error << ", deviation " << deviation << "\n";
	return std::abs(error) > 3 * deviation ? 1 : 0;
}

/** How many parameters are further from the truth than three deviations. */
int outsiders(const WrongStart& start, const DriveResult& result)
{
	const CalibrationEstimate& c = result.calibration;
	const CalibrationDeviations& d = result.deviations;
	const WheelIntrinsics truth = start.drive->wheel_model.actual();
	int count = outside("k_left", c.wheels.k_left - truth.k_left, d.wheels->x());
	count += outside("k_right", c.wheels.k_right - truth.k_right, d.wheels->y());
	count += outside("track, m", c.wheels.track_m - truth.track_m, d.wheels->z());
	count += outside("t_d, s", c.camera_time_offset_s - WrongStart::kOffset_d_s, *d.camera_time_offset_s);
	count += outside("t_w, s", c.wheel_time_offset_s - WrongStart::kOffset_w_s, *d.wheel_time_offset_s);
	const Vector6d T_BO = poseMinus(c.T_BO, start.T_BO), T_BC = poseMinus(c.T_BC, start.T_BC);
	const Eigen::Vector3d p_O = start.T_BO.R.conjugate() * T_BO.head<3>();
	const char* const axes[] = {"x", "y", "z", "roll", "pitch", "yaw"};
	for (int i : {0, 1}) count += outside(std::string("T_BO ") + axes[i] + ", m", p_O[i], (*d.T_BO)[i]);
	for (int i : {3, 4, 5}) count += outside(std::string("T_BO ") + axes[i] + ", rad", T_BO[i], (*d.T_BO)[i]);
	for (int i = 0; i < 6; ++i) count += outside("T_BC " + std::to_string(i), T_BC[i], (*d.T_BC)[i]);
	return count;
}

/** Whether a calibration is the one given, to the last bit. */
bool isGiven(const CalibrationEstimate& c, const Calibration& given)
{
	const Pose3 T_BO = given.T_BO();
	return c.camera_time_offset_s == 0 && c.wheel_time_offset_s == 0 && c.T_BO.p == T_BO.p && c.T_BO.R.coeffs() == T_BO.R.coeffs();
}
}  // namespace

TEST(OnlineCalibration, ConvergesFromAWrongStart)
{
	int parameters = 0, out = 0;
	for (int seed = 1; seed <= test::seedsOf(2); ++seed)
	{
		const WrongStart start(lively(seed));
		const DriveResult with = runDrive(*start.drive, doubting());
		const DriveResult without = runDrive(*start.drive, uncalibrated());
		const double ate_m = errorsOf(*start.drive, with).ate_xyz_m, without_m = errorsOf(*start.drive, without).ate_xyz_m;
		measured("ATE from a wrong start, calibrating", 1e3 * ate_m, "mm; not calibrating: " + std::to_string(1e3 * without_m));
		EXPECT_LT(ate_m, 0.5 * without_m);
		EXPECT_EQ(with.counters.reinitializations, 0);
		out += outsiders(start, with);
		parameters += 16;
		EXPECT_LT(*with.deviations.camera_time_offset_s, 2e-3);
		EXPECT_LT(*with.deviations.wheel_time_offset_s, 5e-3);
		EXPECT_TRUE(with.deviations.lever_arm_started && with.deviations.yaw_started && with.deviations.camera_offset_started &&
		            with.deviations.wheel_offset_started);
	}
	measured("parameters further off than three deviations", out, "of " + std::to_string(parameters));
	EXPECT_LE(out, parameters / 20);
}

TEST(OnlineCalibration, HurtsNothingWhereTheStartWasRight)
{
	for (int seed = 1; seed <= test::seedsOf(2); ++seed)
	{
		const Drive drive(lively(seed, "straight 0.8 m, rotate 100 deg, stand 1 s, arc 0.6 m 90 deg, straight 0.4 m, rotate -120 deg"));
		const double with_m = errorsOf(drive, runDrive(drive, calibrating())).ate_xyz_m;
		const double without_m = errorsOf(drive, runDrive(drive, optionsOf(Mode::viwo))).ate_xyz_m;
		measured("ATE from a right start, calibrating", 1e3 * with_m, "mm; not calibrating: " + std::to_string(1e3 * without_m));
		EXPECT_LT(with_m, 1.2 * without_m + 5e-4);
	}
}

TEST(OnlineCalibration, NothingMovesBeforeTheMotionShowsIt)
{
	for (const std::string& route : {std::string("stand 10 s"), std::string("straight 4 m")})
	{
		DriveSetup setup(route);
		setup.route.speed_m_s = 0.3;
		setup.route.initial_speed = route != "stand 10 s";
		const Drive drive(setup);
		EstimatorOptions options = calibrating();
		options.factors.estimate_T_BO = route == "stand 10 s";
		const DriveResult result = runDrive(drive, options);
		EXPECT_TRUE(isGiven(result.calibration, drive.calibration)) << route;
		EXPECT_FALSE(result.deviations.camera_offset_started || result.deviations.wheel_offset_started ||
		             result.deviations.lever_arm_started);
		EXPECT_DOUBLE_EQ(*result.deviations.camera_time_offset_s, 0.02);
		EXPECT_DOUBLE_EQ(*result.deviations.wheel_time_offset_s, 0.02);
	}
}

TEST(OnlineCalibration, WhatWasLearnedStaysOnALongStraightAndStanding)
{
	// Once the motion has shown the parameters, minutes that say nothing of them must not carry them away.
	const WrongStart start(
	    lively(1, "2 x (straight 0.6 m, rotate 100 deg, stand 1 s, arc 0.5 m 90 deg, rotate -120 deg), straight 6 m, stand 10 s"));
	CalibrationEstimate at_begin;
	CalibrationDeviations deviations;
	bool taken = false;
	const double calm_s = start.drive->motion.duration_s() - 10 - 6 / 0.4 - 1;
	const DriveResult result = runDrive(*start.drive, doubting(),
	                                    [&](const Estimator& estimator, const FrameEstimate& e)
	                                    {
		                                    if (taken || start.drive->secondsOf(e.t_ns) < calm_s) return;
		                                    taken = true;
		                                    at_begin = estimator.calibration();
		                                    deviations = estimator.calibrationDeviations();
	                                    });
	ASSERT_TRUE(taken);
	const CalibrationEstimate& c = result.calibration;
	const double t_d_s = c.camera_time_offset_s - at_begin.camera_time_offset_s,
	             t_w_s = c.wheel_time_offset_s - at_begin.wheel_time_offset_s;
	measured("t_d over 15 s of straight and 10 s of standing", 1e3 * t_d_s,
	         "ms; deviation " + std::to_string(1e3 * *deviations.camera_time_offset_s));
	measured("t_w", 1e3 * t_w_s, "ms; deviation " + std::to_string(1e3 * *deviations.wheel_time_offset_s));
	EXPECT_LT(std::abs(t_d_s), *deviations.camera_time_offset_s);
	EXPECT_LT(std::abs(t_w_s), *deviations.wheel_time_offset_s);
	const Vector6d moved = poseMinus(c.T_BO, at_begin.T_BO);
	measured("T_BO", 1e3 * moved.head<3>().norm(), "mm, " + std::to_string(moved.tail<3>().norm() / kDegree) + " deg");
	EXPECT_LT((start.T_BO.R.conjugate() * moved.head<3>()).head<2>().norm(), deviations.T_BO->head<2>().norm());
	EXPECT_LT(std::abs(moved[5]), 2 * (*deviations.T_BO)[5]);
}

TEST(OnlineCalibration, WheelClockWithoutACamera)
{
	DriveSetup setup = lively(1);
	setup.wheels.clock_offset_ms = -20;
	const Drive drive(setup);
	EstimatorOptions options = calibrating(Mode::wio);
	options.factors.estimate_T_BO = false;
	const DriveResult result = runDrive(drive, options);
	EXPECT_EQ(result.calibration.camera_time_offset_s, 0);
	EXPECT_FALSE(result.deviations.camera_time_offset_s);
	EXPECT_EQ(outside("t_w in mode wio, s", result.calibration.wheel_time_offset_s + 0.02, *result.deviations.wheel_time_offset_s), 0);
	EXPECT_LT(*result.deviations.wheel_time_offset_s, 5e-3);
}

TEST(OnlineCalibration, CameraClockWithoutWheels)
{
	DriveSetup setup("free 20 s");
	setup.route.speed_m_s = 0.4;
	setup.route.free_speed_amplitudes = {0.5, 0.4};
	setup.route.free_speed_periods_s = {3.0, 1.7};
	setup.route.free_yaw_rate_amplitudes_rad_s = {0.5, 0.3};
	setup.route.free_yaw_rate_periods_s = {5.0, 2.3};
	setup.route.acceleration_m_s2 = 2;
	setup.tracks.clock_offset_s = -0.02;
	const Drive drive(setup);
	const DriveResult result = runDrive(drive, calibrating(Mode::vio));
	EXPECT_EQ(outside("t_d in mode vio, s", result.calibration.camera_time_offset_s + 0.02, *result.deviations.camera_time_offset_s), 0);
	EXPECT_LT(*result.deviations.camera_time_offset_s, 2e-3);
	EXPECT_FALSE(result.deviations.wheel_time_offset_s || result.deviations.T_BO || result.deviations.wheels);
}
}  // namespace viwo
