#include <viwo/core/Scalars.h>

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
using test::measured;
using test::optionsOf;

/** Errors of the state at the first pose. */
struct StartErrors
{
	double first_pose_s = 0, tilt_rad = 0, velocity_m_s = 0, yaw_bias_rad_s = 0;
	double yaw_sigma_rad = 0, start_m = 0;

	void takeWorst(const StartErrors& other)
	{
		first_pose_s = std::max(first_pose_s, other.first_pose_s);
		tilt_rad = std::max(tilt_rad, other.tilt_rad);
		velocity_m_s = std::max(velocity_m_s, other.velocity_m_s);
		yaw_bias_rad_s = std::max(yaw_bias_rad_s, other.yaw_bias_rad_s);
		start_m = std::max(start_m, other.start_m);
	}
};

StartErrors startErrors(const Drive& drive, const EstimatorOptions& options)
{
	StartErrors errors;
	errors.first_pose_s = 1e9;
	const DriveResult result = runDrive(drive, options);
	for (const FrameEstimate& e : result.estimates)
	{
		if (!e.has_pose) continue;
		const double t_s = drive.secondsOf(e.t_ns);
		const auto truth = drive.motion.at(t_s);
		const Pose3& T_OB = drive.calibration.T_OB;
		const Eigen::Vector3d up = truth.T_WO.R.conjugate() * Eigen::Vector3d::UnitZ(),
		                      up_estimated = e.T_WO.R.conjugate() * Eigen::Vector3d::UnitZ();
		const Eigen::Vector3d v_O = truth.T_WO.R.conjugate() * truth.v_WO + truth.w_O.cross(T_OB.p);
		const Eigen::Vector3d v_O_estimated = T_OB.R * (e.state.T_WB.R.conjugate() * e.state.v_WB);
		errors.first_pose_s = secondsBetween(drive.frames.front().t_ns, e.t_ns);
		errors.tilt_rad = std::acos(std::min(1.0, up.dot(up_estimated)));
		errors.velocity_m_s = (v_O - v_O_estimated).norm();
		errors.yaw_bias_rad_s = std::abs((T_OB.R * (e.state.b_g - drive.imu_model.biasAt(t_s).gyro_rad_s)).z());
		errors.start_m = e.T_WO.p.norm() + std::abs(yawOf(e.T_WO.R));
		break;
	}
	return errors;
}

TEST(WheelStart, InMidMotionWithinASecond)
{
	for (const std::string& route :
	     {std::string("straight 2 m"), std::string("arc 1 m 90 deg"), std::string("rotate 90 deg"), std::string("stand 3 s")})
	{
		StartErrors worst;
		for (int seed = 1; seed <= test::seedsOf(5); ++seed)
		{
			DriveSetup setup(route, seed);
			setup.route.initial_speed = route.find("stand") == std::string::npos;
			setup.route.duration_s = 1.5;
			setup.wheels.phase_ms = 13;
			setup.tracks.begin_s = 0.02;
			worst.takeWorst(startErrors(Drive(setup), optionsOf(Mode::viwo)));
		}
		measured("worst start in " + route + ": first pose", worst.first_pose_s, "s");
		measured("  tilt", worst.tilt_rad / kDegree, "deg");
		measured("  velocity", 100 * worst.velocity_m_s, "cm/s");
		measured("  bias of the yaw rate", 1e3 * worst.yaw_bias_rad_s, "mrad/s");
		EXPECT_LE(worst.first_pose_s, 1.0) << route;
		EXPECT_LE(worst.tilt_rad, 1 * kDegree) << route;
		EXPECT_LE(worst.velocity_m_s, 0.02) << route;
		EXPECT_LE(worst.yaw_bias_rad_s, 3e-3) << route;
		EXPECT_LE(worst.start_m, 1e-3) << route;  // W is O at the first pose
	}
}

/** Without the floor's help the accelerometer alone gives the tilt, whatever it is. */
TEST(WheelStart, TiltFromTheAccelerometer)
{
	DriveSetup setup = DriveSetup::perfect("stand 2 s");
	setup.floor.height_rms_mm = 40;
	setup.floor.wavelength_min_m = 3.5;
	setup.floor.wavelength_max_m = 4;
	EstimatorOptions options = optionsOf(Mode::wio);
	options.factors.plane_factor = false;
	const Drive drive(setup);
	const double tilt_rad = std::acos(drive.motion.at(0).T_WO.R.toRotationMatrix()(2, 2));
	measured("true tilt", tilt_rad / kDegree, "deg");
	ASSERT_GT(tilt_rad, 0.5 * kDegree);
	EXPECT_LT(startErrors(drive, options).tilt_rad, 0.01 * kDegree);
}
}  // namespace
}  // namespace viwo
