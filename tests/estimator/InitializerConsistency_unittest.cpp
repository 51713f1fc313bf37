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

/** Normalised errors over many draws of all that is uncertain. */
struct Statistics
{
	double scale_z2 = 0, gyro_z2 = 0, tilt_z2 = 0, chi2 = 0, gyro_chi2 = 0, worst_scale = 0, worst_up_rad = 0, worst_velocity = 0,
	       worst_gyro = 0;
	int ok = 0;
};

Statistics run(PlanarDrive drive, int seeds)
{
	const PriorOptions priors;
	Statistics s;
	for (int seed = 1; seed <= seeds; ++seed)
	{
		std::mt19937_64 generator(static_cast<uint64_t>(seed));
		std::normal_distribution<double> normal(0, 1);
		const auto draw3 = [&] { return Eigen::Vector3d(normal(generator), normal(generator), normal(generator)); };
		drive.b_a = priors.acc_bias_m_s2 * draw3();
		drive.b_g = 0.01 * draw3();
		drive.wheels.k_left = 1 + priors.wheel_scale * normal(generator);
		drive.wheels.k_right = 1 + priors.wheel_scale * normal(generator);
		drive.wheels.track_m = 0.23 * (1 + priors.track_relative * normal(generator));
		InitializerWindow w(drive, Pose3(forwardOpticalAxes(), {0.25, 0.02, 0.3}),
		                    {0.3 / 250, true, 1000003 * static_cast<uint64_t>(seed)});
		const InitializerResult result =
		    Initializer(w.calibration, nominalBelief(EstimatorOptions(), w.calibration), 9.81, {}).align(w.sfm, w.imu, w.wheels);
		if (result.status != InitializerStatus::ok) continue;
		++s.ok;
		const InitializerErrors e = errorsOf(result, w);
		s.scale_z2 += std::pow(e.scale / result.alignment.scale_sigma, 2);
		const Eigen::Vector3d gyro_error = result.gyro.b_g - drive.b_g;
		s.gyro_z2 += gyro_error.dot(result.gyro.covariance.inverse() * gyro_error) / 3;
		s.tilt_z2 += std::pow(e.up_rad / result.alignment.up_sigma_rad, 2) / 2;
		s.chi2 += result.alignment.chi2_per_dof;
		s.gyro_chi2 += result.gyro.chi2_per_dof;
		s.worst_scale = std::max(s.worst_scale, e.scale);
		s.worst_up_rad = std::max(s.worst_up_rad, e.up_rad);
		s.worst_velocity = std::max(s.worst_velocity, e.velocity_m_s);
		s.worst_gyro = std::max(s.worst_gyro, e.gyro_rad_s);
	}
	for (double* mean : {&s.scale_z2, &s.gyro_z2, &s.tilt_z2, &s.chi2, &s.gyro_chi2}) *mean /= std::max(1, s.ok);
	return s;
}

TEST(InitializerConsistency, ErrorsAreAsLargeAsTheCovarianceSays)
{
	PlanarDrive arc;
	arc.T_OB = Pose3(so3::expQuaternion({0.02, -0.03, 0.1}), {0.1, -0.05, 0.25});
	PlanarDrive straight = arc;
	straight.w_rad_s = 0;
	PlanarDrive free = arc;
	free.v_swing_m_s = 0.08, free.w_swing_rad_s = 0.3;
	constexpr int kSeeds = 20;
	for (const PlanarDrive& drive : {arc, straight, free})
	{
		const Statistics s = run(drive, kSeeds);
		std::cout << "[measured] " << s.ok << " of " << kSeeds << " start; z^2 of scale " << s.scale_z2 << ", gyro bias " << s.gyro_z2
		          << ", tilt " << s.tilt_z2 << "; chi2/dof " << s.chi2 << " (gyro " << s.gyro_chi2 << "); worst: scale " << s.worst_scale
		          << ", tilt " << s.worst_up_rad * 180 / M_PI << " deg, velocity " << s.worst_velocity << " m/s, gyro bias " << s.worst_gyro
		          << " rad/s\n";
		EXPECT_EQ(s.ok, kSeeds);
		for (const double z2 : {s.scale_z2, s.gyro_z2, s.tilt_z2}) EXPECT_LT(z2, 2.0);
		EXPECT_GT(s.gyro_z2, 0.4);
		EXPECT_GT(s.scale_z2, 0.3);
		EXPECT_LT(s.chi2, 1.6);
		EXPECT_LT(s.worst_velocity, 0.02);
	}
}
}  // namespace
}  // namespace viwo
