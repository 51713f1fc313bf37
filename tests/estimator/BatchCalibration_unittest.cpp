#include <gtest/gtest.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>
#include <viwo/estimator/BatchCalibration.h>

#include <random>

#include "SimulatedDrive.h"
#include "calibration/BatchStates.h"
#include "residuals/BlockAlgebra.h"

namespace viwo
{
namespace
{
using test::Drive;
using test::DriveSetup;
using test::measured;

/** Brisk enough for the accelerometer to tell the scale. */
DriveSetup briskDrive(const std::string& segments)
{
	DriveSetup setup(segments);
	setup.route.speed_m_s = 0.5;
	setup.route.yaw_rate_rad_s = 1;
	setup.route.acceleration_m_s2 = 1;
	setup.route.yaw_acceleration_rad_s2 = 2;
	setup.tracks.max_features = 30;
	setup.tracks.clock_offset_s = 0.012;
	setup.wheels.clock_offset_ms = -8;
	return setup;
}

SensorRig truthOf(const Drive& drive, const DriveSetup& setup)
{
	return {drive.calibration.T_BO(), drive.calibration.T_BC(), drive.wheel_model.actual(), setup.tracks.clock_offset_s,
	        1e-3 * setup.wheels.clock_offset_ms};
}

/** 2 % scale, 3 % track, 2 cm, 1 degree and 20 ms off. */
RigVector usualError(double track_m)
{
	RigVector d;
	d << 0.02, 0.02, -0.03 * track_m, 0.02, -0.02, 0, Eigen::Vector3d(1, -1, 1) * kDegree, -0.02, 0.02, 0.02,
	    Eigen::Vector3d(-1, 1, 1) * kDegree, -0.02, 0.02;
	return d;
}

BatchCalibrationInput inputOf(const Drive& drive, const SensorRig& start)
{
	BatchCalibrationInput in;
	in.frames = drive.frames;
	in.imu = drive.imu;
	in.wheels = drive.wheels;
	in.camera = drive.calibration.camera;
	in.start = start;
	return in;
}

constexpr const char* kTour =
    "stand 2 s, straight 1 m, rotate 110 deg, straight 0.9 m, rotate -150 deg, arc 0.5 m 270 deg, arc 0.5 m -300 deg, straight 0.8 m, "
    "rotate "
    "120 deg, straight 0.9 m, stand 1 s";

SensorRig tiltedRig()
{
	const auto turned = [](double x, double y, double z) { return so3::expQuaternion({x, y, z}); };
	return {{turned(0.3, -0.2, 1.1), {0.2, -0.1, 0.4}}, {turned(-0.7, 0.4, 0.2), {0.05, 0.1, -0.15}}, {1.01, 0.99, 0.25}, 0.01, -0.02};
}

TEST(SensorRig, DifferenceUndoesPlus)
{
	std::mt19937 generator(1);
	std::normal_distribution<double> normal;
	RigVector d;
	for (int i = 0; i < d.size(); ++i) d[i] = 0.1 * normal(generator);
	EXPECT_LT((rigDifference(rigPlus(tiltedRig(), d), tiltedRig()) - d).norm(), 1e-12);
}

TEST(SensorRig, HeightsStayWhileTheRestMoves)
{
	const SensorRig rig = tiltedRig();
	RigVector d = 1e-2 * RigVector::LinSpaced(-3, 4);
	d[RigOrder::imu_lever + 2] = d[RigOrder::camera_lever + 2] = 0;
	const SensorRig moved = rigPlus(rig, d);
	EXPECT_NEAR(moved.T_BO.inverse().p.z(), rig.T_BO.inverse().p.z(), 1e-12);
	EXPECT_NEAR((moved.T_BO.inverse() * moved.T_BC).p.z(), (rig.T_BO.inverse() * rig.T_BC).p.z(), 1e-12);
}

TEST(SensorRig, JacobianIsThatOfTheBlocks)
{
	const SensorRig rig = tiltedRig();
	const RigJacobian J = rigJacobian(rig);
	constexpr double kStep = 1e-6;
	for (int i = 0; i < RigOrder::size; ++i)
	{
		const auto at = [&](double step)
		{
			RigVector delta = RigVector::Zero();
			delta[i] = step;
			SensorRig moved = rig;
			moved.wheels = {rig.wheels.k_left + delta[0], rig.wheels.k_right + delta[1], rig.wheels.track_m + delta[2]};
			moved.T_BO = posePlus(rig.T_BO, delta.segment<6>(RigOrder::imu_lever));
			moved.T_BC = posePlus(rig.T_BC, delta.segment<6>(RigOrder::camera_lever));
			moved.camera_offset_s += delta[RigOrder::camera_offset];
			moved.wheel_offset_s += delta[RigOrder::wheel_offset];
			return rigDifference(moved, rig);
		};
		EXPECT_LT(((at(kStep) - at(-kStep)) / (2 * kStep) - J.col(i)).norm(), 1e-8) << RigOrder::names()[static_cast<size_t>(i)];
	}
}

/** No error beyond its deviation, whatever the drive shows; what it does not show is kept. */
void expectHonestDeviations(const BatchCalibrationResult& result, const SensorRig& truth, const SensorRig& start)
{
	const RigVector error = rigDifference(result.rig, truth), moved = rigDifference(result.rig, start);
	for (int i = 0; i < RigOrder::size; ++i)
	{
		const std::string& name = RigOrder::names()[static_cast<size_t>(i)];
		if (!result.observed[i])
		{
			std::cout << "[measured] " << name << ": not observed\n";
			EXPECT_NEAR(moved[i], 0, 1e-6) << name;
			continue;
		}
		measured(name + ", error over deviation " + std::to_string(error[i] / result.deviations[i]) + ", error", error[i], "");
		EXPECT_LT(std::abs(error[i]), 4 * result.deviations[i]) << name;
	}
}

TEST(BatchCalibration, FindsTheRigFromAWrongStart)
{
	const DriveSetup setup = briskDrive(kTour);
	const Drive drive(setup);
	const SensorRig truth = truthOf(drive, setup), start = rigPlus(truth, usualError(truth.wheels.track_m));
	const BatchCalibrationResult result = calibrateInBatch(inputOf(drive, start), {}, {});
	ASSERT_EQ(result.problem, "");
	const RigVector error = rigDifference(result.rig, truth);
	expectHonestDeviations(result, truth, start);
	for (const int height : {RigOrder::imu_lever + 2, RigOrder::camera_lever + 2}) EXPECT_FALSE(result.observed[height]) << height;
	EXPECT_NEAR(result.rig.T_BO.inverse().p.z(), start.T_BO.inverse().p.z(), 1e-9);
	for (const int i :
	     {RigOrder::left_scale + 0, RigOrder::right_scale + 0, RigOrder::track + 0, RigOrder::imu_lever + 0, RigOrder::imu_lever + 1,
	      RigOrder::imu_rotation + 2, RigOrder::camera_rotation + 2, RigOrder::camera_offset + 0, RigOrder::wheel_offset + 0})
		EXPECT_TRUE(result.observed[i]) << RigOrder::names()[static_cast<size_t>(i)];
	EXPECT_LT(std::abs(error[RigOrder::camera_offset]), 1e-3);
	EXPECT_LT(std::abs(error[RigOrder::track]), 0.01 * truth.wheels.track_m);
	EXPECT_LT(result.after.wheel_forward_mm, result.before.wheel_forward_mm);
	EXPECT_EQ(result.slip_s, 0);
}

TEST(BatchCalibration, AReferenceTellsTheScaleBetter)
{
	DriveSetup setup = briskDrive("stand 2 s, 3 x (straight 1 m, rotate 120 deg), stand 1 s");
	const Drive drive(setup);
	const SensorRig truth = truthOf(drive, setup), start = rigPlus(truth, usualError(truth.wheels.track_m));
	BatchCalibrationInput input = inputOf(drive, start);
	BatchCalibrationOptions options;
	options.max_rounds = 4;
	options.acc_scale = 0.02;  // of an accelerometer that tells no scale
	const BatchCalibrationResult without = calibrateInBatch(input, options, {});
	const Pose3 T_RW(so3::expQuaternion({0, 0, 1.3}), {5, -2, 0});  // of the reference's own frame
	const Trajectory exact = drive.motion.groundTruth(25);
	for (const StampedPose& pose : exact.poses()) input.reference.push_back({pose.t_ns, T_RW * pose.T});
	options.reference_position_m = 0.002;
	const BatchCalibrationResult with = calibrateInBatch(input, options, {});
	ASSERT_EQ(without.problem + with.problem, "");
	measured("deviation of the left wheel's scale without and with a reference", without.deviations[0], "");
	measured("", with.deviations[0], "");
	EXPECT_LT(with.deviations[0], 0.5 * without.deviations[0]);
	const RigVector error = rigDifference(with.rig, truth);
	for (int i = 0; i < RigOrder::imu_lever; ++i)
		EXPECT_LT(std::abs(error[i]), 4 * with.deviations[i]) << RigOrder::names()[static_cast<size_t>(i)];
}

TEST(BatchCalibration, AStraightLineSaysNothingOfTrackAndLeverArms)
{
	const DriveSetup setup = briskDrive("stand 2 s, 4 x (straight 1 m, stand 1 s), straight 1 m, stand 5 s");
	const Drive drive(setup);
	const SensorRig truth = truthOf(drive, setup);
	SensorRig start = truth;
	start.T_BO.p += 0.01 * (start.T_BO.R * Eigen::Vector3d(1, 1, 0));
	start.wheels.track_m *= 1.01;
	const BatchCalibrationResult result = calibrateInBatch(inputOf(drive, start), {}, {});
	ASSERT_EQ(result.problem, "");
	const RigVector kept = rigDifference(result.rig, start);
	for (const int i : {RigOrder::track + 0, RigOrder::imu_lever + 0, RigOrder::imu_lever + 1, RigOrder::camera_lever + 1})
	{
		EXPECT_FALSE(result.observed[i]) << RigOrder::names()[static_cast<size_t>(i)] << " " << result.deviations[i];
		EXPECT_NEAR(kept[i], 0, 1e-9) << RigOrder::names()[static_cast<size_t>(i)];
	}
	EXPECT_TRUE(result.observed[RigOrder::imu_rotation + 2]);  // where forward is
}

/** The result of a drive at low speed from the right start, which it must not spoil. */
BatchCalibrationResult calibratedGently(const std::string& segments, SensorRig& truth)
{
	DriveSetup setup(segments);
	setup.tracks.max_features = 30;
	const Drive drive(setup);
	truth = truthOf(drive, setup);
	const BatchCalibrationResult result = calibrateInBatch(inputOf(drive, truth), {}, {});
	EXPECT_EQ(result.problem, "");
	expectHonestDeviations(result, truth, truth);
	return result;
}

/** Wheels at low speed tell little of their size, and their noise is as large as what the accelerometer sees. */
TEST(BatchCalibration, NoiseOnAGentleDriveDoesNotPassForSize)
{
	SensorRig truth;
	calibratedGently("stand 2 s, 4 x (straight 1.5 m, rotate 90 deg), stand 1 s", truth);
}

TEST(BatchCalibration, AConstantArcHoldsWhatItDoesNotShow)
{
	SensorRig truth;
	const BatchCalibrationResult result = calibratedGently("stand 2 s, arc 1 m 300 deg, stand 1 s", truth);
	EXPECT_FALSE(result.observed[RigOrder::track]);
	EXPECT_EQ(result.rig.wheels.track_m, truth.wheels.track_m);
}

TEST(BatchCalibration, AFarStartIsNoted)
{
	DriveSetup setup = briskDrive("stand 2 s, 3 x (straight 1 m, rotate 120 deg), stand 1 s");
	const Drive drive(setup);
	SensorRig start = truthOf(drive, setup);
	EXPECT_TRUE(calibrateInBatch(inputOf(drive, start), {}, {}).notes.empty());
	start.wheels.track_m *= 1.4;
	const BatchCalibrationResult result = calibrateInBatch(inputOf(drive, start), {}, {});
	ASSERT_EQ(result.problem, "");
	ASSERT_FALSE(result.notes.empty());
	EXPECT_NE(result.notes.front().find("track is"), std::string::npos) << result.notes.front();
}

TEST(BatchCalibration, SaysWhatIsMissing)
{
	const DriveSetup setup = briskDrive("stand 24 s");
	const Drive drive(setup);
	const BatchCalibrationInput standing = inputOf(drive, truthOf(drive, setup));
	const auto problemOf = [](const BatchCalibrationInput& input) { return calibrateInBatch(input, {}, {}).problem; };
	EXPECT_NE(problemOf(standing).find("moves by 0.00 m"), std::string::npos) << problemOf(standing);
	BatchCalibrationInput in = standing;
	in.frames.clear();
	EXPECT_NE(problemOf(in).find("no images"), std::string::npos);
	in = standing;
	in.imu.clear();
	EXPECT_NE(problemOf(in).find("no IMU"), std::string::npos);
	in = standing;
	in.wheels.clear();
	EXPECT_NE(problemOf(in).find("no wheel odometry"), std::string::npos);
	in = standing;
	in.wheels.resize(100);
	EXPECT_NE(problemOf(in).find("overlap for"), std::string::npos) << problemOf(in);
	for (FeatureFrame& frame : in.frames) frame.features.clear();
	in = inputOf(Drive(briskDrive("straight 6 m, stand 15 s")), standing.start);
	for (FeatureFrame& frame : in.frames) frame.features.clear();
	EXPECT_NE(problemOf(in).find("usable tracks"), std::string::npos) << problemOf(in);
	in.reference.push_back({1, Pose3()});
	EXPECT_NE(problemOf(in).find("reference trajectory covers 0 %"), std::string::npos) << problemOf(in);
}

TEST(BatchCalibration, RefusesWheelsThatSlip)
{
	DriveSetup setup = briskDrive("stand 2 s, straight 2 m, rotate 120 deg, straight 2 m, rotate 120 deg, straight 2 m, stand 1 s");
	setup.wheels.slips = {3, 3, 0.4, 0, 9, 3, 0.4, 1};
	const Drive drive(setup);
	const BatchCalibrationResult result = calibrateInBatch(inputOf(drive, truthOf(drive, setup)), {}, {});
	EXPECT_NE(result.problem.find("contradict camera and IMU"), std::string::npos) << result.problem << " slip " << result.slip_s;
}
}  // namespace
}  // namespace viwo
