#include "Initializer.h"

#include <gtest/gtest.h>
#include <viwo/core/So3.h>

#include <iostream>

#include "InitializerWindow.h"

namespace viwo
{
namespace
{
using test::errorsOf;
using test::InitializerErrors;
using test::InitializerWindow;
using test::PlanarDrive;

constexpr double kGravity = 9.81;
const Pose3 kForwardCamera(forwardOpticalAxes(), {0.25, 0.02, 0.3});

PlanarDrive arc()
{
	PlanarDrive d;
	d.T_OB = Pose3(so3::expQuaternion({0.02, -0.03, 0.1}), {0.1, -0.05, 0.25});
	d.b_g = {0.01, -0.02, 0.015};
	return d;
}
PlanarDrive free()
{
	PlanarDrive d = arc();
	d.v_swing_m_s = 0.08;
	d.w_swing_rad_s = 0.3;
	return d;
}
PlanarDrive straight()
{
	PlanarDrive d = arc();
	d.w_rad_s = 0;
	return d;
}
/** Jerky enough for an IMU to tell the scale by itself. */
PlanarDrive lively()
{
	PlanarDrive d = free();
	d.v_m_s = 0.4, d.v_swing_m_s = 0.5, d.v_rate_rad_s = 8, d.w_swing_rad_s = 0.8, d.w_rate_rad_s = 5;
	return d;
}

Initializer initializerOf(const InitializerWindow& w, const InitializerOptions& options = {})
{
	return {w.calibration, nominalBelief(EstimatorOptions(), w.calibration), kGravity, options};
}

InitializerResult align(InitializerWindow& w, const InitializerOptions& options = {})
{
	return initializerOf(w, options).align(w.sfm, w.imu, w.wheels);
}

void expectExact(const InitializerResult& result, const InitializerWindow& w, const char* what)
{
	ASSERT_EQ(result.status, InitializerStatus::ok) << what << ": " << toString(result.status) << ", chi2 " << result.alignment.chi2_per_dof
	                                                << ", scale sigma " << result.alignment.scale_sigma;
	const InitializerErrors e = errorsOf(result, w);
	std::cout << "[measured] " << what << ": scale " << e.scale << ", gyro bias " << e.gyro_rad_s << " rad/s, vertical "
	          << e.up_rad * 180 / M_PI << " deg, velocity " << e.velocity_m_s << " m/s (scale sigma " << result.alignment.scale_sigma
	          << ", condition " << result.alignment.condition << ")\n";
	EXPECT_LT(e.scale, 1e-3) << what;
	EXPECT_LT(e.gyro_rad_s, 1e-4) << what;
	EXPECT_LT(e.up_rad, 0.05 * M_PI / 180) << what;
	EXPECT_LT(e.velocity_m_s, 1e-3) << what;
}

TEST(Initializer, ExactOnExactData)
{
	InitializerWindow on_arc(arc(), kForwardCamera), swinging(free(), kForwardCamera), on_line(straight(), kForwardCamera);
	expectExact(align(on_arc), on_arc, "arc");
	expectExact(align(swinging), swinging, "free");
	expectExact(align(on_line), on_line, "straight at constant speed");
}

TEST(Initializer, AnyMountingOfTheImu)
{
	const std::vector<Eigen::Vector3d> mountings = {{M_PI, 0, 0}, {0, M_PI / 2, 0}, {-M_PI / 2, 0, 0}, {1.2, -0.8, 2}};
	for (const Eigen::Vector3d& mounting : mountings)
	{
		PlanarDrive d = free();
		d.T_OB.R = so3::expQuaternion(mounting);
		InitializerWindow w(d, kForwardCamera);
		expectExact(align(w), w, "mounting");
	}
}

TEST(Initializer, CameraThatLooksBackAndDown)
{
	const Pose3 T_OC(so3::expQuaternion({0, 0, 2.5}) * forwardOpticalAxes() * so3::expQuaternion({-0.3, 0, 0}), {-0.1, 0.1, 0.4});
	InitializerWindow w(free(), T_OC);
	expectExact(align(w), w, "camera backwards");
}

TEST(Initializer, OptionsOfThePaper)
{
	InitializerOptions options;
	options.gyro_bias = GyroBiasMethod::paper_mean;
	options.gravity_start = GravityStart::vehicle_up;
	InitializerWindow w(free(), kForwardCamera);
	expectExact(align(w, options), w, "plain mean of the biases, gravity from O's z");
}

TEST(Initializer, WithoutWheelsNeedsAcceleration)
{
	InitializerWindow w(lively(), kForwardCamera), on_line(straight(), kForwardCamera);
	w.wheels.clear();
	on_line.wheels.clear();
	expectExact(align(w), w, "vision and IMU alone");
	const InitializerResult dull = align(on_line);
	EXPECT_EQ(dull.status, InitializerStatus::ill_conditioned) << toString(dull.status) << ", scale sigma " << dull.alignment.scale_sigma;
}

TEST(Initializer, TurningOnTheSpotIsRejected)
{
	PlanarDrive d = arc();
	d.v_m_s = 0;
	d.w_rad_s = 0.4;
	InitializerWindow w(d, Pose3(forwardOpticalAxes(), {0, 0, 0.3}));
	EXPECT_EQ(w.sfm.status, SfmStatus::not_enough_parallax);
	EXPECT_EQ(align(w).status, InitializerStatus::no_reconstruction);

	// A reconstruction of such a motion that claims to have succeeded.
	w.sfm.status = SfmStatus::ok;
	w.sfm.T_c0_ck.clear();
	for (const Pose3& T : w.T_WC) w.sfm.T_c0_ck.push_back({w.T_WC.front().R.conjugate() * T.R, Eigen::Vector3d::Zero()});
	w.sfm.interval_covariance = 1e-6 * Eigen::MatrixXd::Identity(60, 60);
	EXPECT_EQ(align(w).status, InitializerStatus::ill_conditioned);
}

TEST(Initializer, TurningWithTheCameraOffTheAxleGivesTheScale)
{
	PlanarDrive d = arc();
	d.v_m_s = 0;
	d.w_rad_s = 0.6;
	InitializerWindow w(d, Pose3(forwardOpticalAxes(), {0.6, 0, 0.3}));
	ASSERT_EQ(w.sfm.status, SfmStatus::ok);
	expectExact(align(w), w, "turning, camera off the axle");
}

TEST(Initializer, RejectsWhatDoesNotFit)
{
	InitializerWindow mirrored(free(), kForwardCamera);
	for (Pose3& T : mirrored.sfm.T_c0_ck) T.p = -T.p;
	EXPECT_NE(align(mirrored).status, InitializerStatus::ok);

	PlanarDrive sick = free();
	sick.b_g = {0.3, 0, 0};
	InitializerWindow w(sick, kForwardCamera);
	EXPECT_EQ(align(w).status, InitializerStatus::bad_gyro_bias);

	PlanarDrive falling = free();
	falling.gravity_m_s2 = 0;
	InitializerWindow f(falling, kForwardCamera);
	EXPECT_EQ(align(f).status, InitializerStatus::bad_gravity);

	InitializerWindow slipping(free(), kForwardCamera);
	for (size_t k = 4; k < 7; ++k)
	{
		WheelPreintegration spun{WheelNoise(), WheelIntrinsics()};
		spun.integrate({0.1, 0.6, 0.6});
		slipping.wheels[k] = spun;
	}
	const InitializerStatus status = align(slipping).status;
	EXPECT_TRUE(status == InitializerStatus::bad_residual || status == InitializerStatus::bad_gyro_bias) << toString(status);

	InitializerWindow short_of_one(free(), kForwardCamera);
	short_of_one.imu.pop_back();
	EXPECT_EQ(align(short_of_one).status, InitializerStatus::no_reconstruction);
}

TEST(Initializer, StatesInW)
{
	InitializerWindow w(free(), kForwardCamera);
	const Initializer initializer = initializerOf(w);
	const InitializerResult result = initializer.align(w.sfm, w.imu, w.wheels);
	ASSERT_EQ(result.status, InitializerStatus::ok);
	const Pose3 wanted(so3::expQuaternion({0, 0, -2.1}), {3, -4, 5});
	const size_t origin = 10;
	const std::vector<NavState> states = initializer.navStates(result, w.imu, origin, wanted);
	ASSERT_EQ(states.size(), 11u);
	const Pose3 T_moved = wanted * w.drive.T_WO(1.0).inverse();  // the same drive, seen from the wanted W
	for (size_t k = 0; k < states.size(); ++k)
	{
		const double t = 0.1 * static_cast<double>(k);
		const Pose3 truth = T_moved * w.drive.T_WB(t);
		EXPECT_EQ(states[k].t_ns, static_cast<int64_t>(k) * 100'000'000);
		EXPECT_LT((states[k].T_WB.p - truth.p).norm(), 1e-3);
		EXPECT_LT(so3::log(truth.R.conjugate() * states[k].T_WB.R).norm(), 1e-3);
		EXPECT_LT((states[k].v_WB - T_moved.R * w.drive.v_WB(t)).norm(), 1e-3);
		EXPECT_EQ(states[k].b_g, result.gyro.b_g);
	}
	const Pose3 T_WO = states[origin].T_WB * w.calibration.T_BO();
	EXPECT_LT((T_WO.p - wanted.p).norm(), 1e-9);
	EXPECT_NEAR(yawOf(T_WO.R), -2.1, 1e-9);
}
}  // namespace
}  // namespace viwo
