#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/core/So3.h>

#include "SimFixtures.h"

namespace viwo::sim
{
namespace
{
using Eigen::Vector3d;

const Vector3d kUp(0, 0, 9.81);

TEST(ImuModel, AgreesWithNumericDerivativesOfTheGroundTruth)
{
	const Motion motion(variedRoute(), FloorOptions(), VibrationOptions(), 11);
	const ImuModel imu(motion, ImuOptions::perfect(), 11);
	const auto T_WB = [&](double t_s) { return motion.at(t_s).T_WO * imu.T_OB(); };
	const double h = 4e-4;
	double worst_force = 0, worst_rate = 0;
	for (size_t i = 10; i + 10 < imu.samples().size(); i += 7)
	{
		const double t = secondsBetween(motion.epoch_ns(), imu.samples()[i].t_ns);
		const Pose3 m2 = T_WB(t - 2 * h), m1 = T_WB(t - h), now = T_WB(t), p1 = T_WB(t + h), p2 = T_WB(t + 2 * h);
		const Vector3d acc_W = (-m2.p + 16 * m1.p - 30 * now.p + 16 * p1.p - p2.p) / (12 * h * h);
		const auto turn = [&](const Pose3& T) { return so3::log(now.R.conjugate() * T.R); };
		const Vector3d rate_B = (turn(m2) - 8 * turn(m1) + 8 * turn(p1) - turn(p2)) / (12 * h);
		worst_force = std::max(worst_force, (now.R.conjugate() * (acc_W + kUp) - imu.samples()[i].acc_m_s2).norm());
		worst_rate = std::max(worst_rate, (rate_B - imu.samples()[i].gyro_rad_s).norm());
	}
	measured("specific force against second differences of position", worst_force, "m/s^2");
	measured("rate against differences of rotation", worst_rate, "rad/s");
	EXPECT_LT(worst_force, 2e-5);
	EXPECT_LT(worst_rate, 1e-7);
}

/** Trapezoidal strapdown integration from the true state. */
double driftOver(const Motion& motion, const ImuModel& imu, double duration_s)
{
	const MotionState start = motion.at(0);
	Pose3 T_WB = start.T_WO * imu.T_OB();
	Vector3d v_WB = start.v_WO + start.T_WO.R * start.w_O.cross(imu.T_OB().p);
	const auto samples = imu.samples(0, duration_s);
	for (size_t i = 0; i + 1 < samples.size(); ++i)
	{
		const double dt_s = secondsBetween(samples[i].t_ns, samples[i + 1].t_ns);
		const Eigen::Quaterniond R_next = T_WB.R * so3::expQuaternion(0.5 * dt_s * (samples[i].gyro_rad_s + samples[i + 1].gyro_rad_s));
		const Vector3d a_0 = T_WB.R * samples[i].acc_m_s2 - kUp, a_1 = R_next * samples[i + 1].acc_m_s2 - kUp;
		T_WB.p += v_WB * dt_s + (2 * a_0 + a_1) * dt_s * dt_s / 6;
		v_WB += 0.5 * (a_0 + a_1) * dt_s;
		T_WB.R = R_next.normalized();
	}
	const Pose3 truth = motion.at(secondsBetween(motion.epoch_ns(), samples.back().t_ns)).T_WO * imu.T_OB();
	return (T_WB.p - truth.p).norm();
}

TEST(ImuModel, NoiseFreeReadingsIntegrateToTheGroundTruth)
{
	const Route route = routeOf("straight 2 m, rotate 90 deg, arc 1 m 120 deg, free 40 s");
	const Motion smooth(route, FloorOptions(), VibrationOptions::off(), 2);
	const double drift_m = driftOver(smooth, ImuModel(smooth, ImuOptions::perfect(), 2), 60);
	measured("position after 60 s of noise-free integration", 1e3 * drift_m, "mm");
	EXPECT_LT(drift_m, 1e-3);
	const Motion shaken(route, FloorOptions(), VibrationOptions(), 2);
	ImuOptions fast = ImuOptions::perfect();
	fast.rate_hz = 2000;
	const double shaken_m = driftOver(shaken, ImuModel(shaken, fast, 2), 60);
	measured("the same with vibration, sampled at 2 kHz", 1e3 * shaken_m, "mm");
	EXPECT_LT(shaken_m, 1e-3);
}

/** Allan deviation at an averaging time of n samples. */
double allanDeviation(const std::vector<ImuSample>& samples, size_t n, double (*component)(const ImuSample&))
{
	double sum = 0, previous = 0;
	size_t count = 0;
	for (size_t block = 0; (block + 1) * n <= samples.size(); ++block)
	{
		double mean = 0;
		for (size_t i = 0; i < n; ++i) mean += component(samples[block * n + i]) / static_cast<double>(n);
		if (block > 0) sum += (mean - previous) * (mean - previous), ++count;
		previous = mean;
	}
	return std::sqrt(0.5 * sum / static_cast<double>(count));
}

TEST(ImuModel, WhiteNoiseHasItsDensityAndSlope)
{
	const Motion still(routeOf("stand 1000 s"));
	ImuOptions options = ImuOptions::perfect();
	options.gyro_noise_rad_s_sqrtHz = 1.7e-4;
	options.acc_noise_m_s2_sqrtHz = 1.6e-3;
	const ImuModel imu(still, options, 5);
	for (const size_t n : {20u, 200u, 600u})
	{
		const double tau_s = static_cast<double>(n) / 200;
		const double gyro = allanDeviation(imu.samples(), n, [](const ImuSample& s) { return s.gyro_rad_s.y(); }) * std::sqrt(tau_s);
		const double acc = allanDeviation(imu.samples(), n, [](const ImuSample& s) { return s.acc_m_s2.x(); }) * std::sqrt(tau_s);
		std::cout << "[measured] Allan deviation x sqrt(tau) at " << tau_s << " s: gyro " << gyro << ", accelerometer " << acc << "\n";
		// Relative deviation of an Allan variance from N blocks is about sqrt(3 / N): 5 % at 3 s.
		EXPECT_NEAR(gyro, 1.7e-4, 0.12 * 1.7e-4);
		EXPECT_NEAR(acc, 1.6e-3, 0.12 * 1.6e-3);
	}
}

TEST(ImuModel, BiasesWalkAsAsked)
{
	const Motion still(routeOf("stand 100 s"));
	ImuOptions options = ImuOptions::perfect();
	options.gyro_walk_rad_s2_sqrtHz = 1e-5;
	options.acc_walk_m_s3_sqrtHz = 2e-4;
	double gyro = 0, acc = 0;
	const int runs = 100;
	for (int seed = 0; seed < runs; ++seed)
	{
		const ImuModel imu(still, options, static_cast<uint64_t>(seed));
		gyro += imu.biasAt(100).gyro_rad_s.squaredNorm() / 3;
		acc += imu.biasAt(100).acc_m_s2.squaredNorm() / 3;
	}
	const double gyro_walk = std::sqrt(gyro / runs / 100), acc_walk = std::sqrt(acc / runs / 100);
	measured("gyro walk", gyro_walk, "rad/s^2/sqrtHz");
	measured("accelerometer walk", acc_walk, "m/s^3/sqrtHz");
	EXPECT_NEAR(gyro_walk, 1e-5, 0.15e-5);
	EXPECT_NEAR(acc_walk, 2e-4, 0.3e-4);
}

TEST(ImuModel, EachEffectAloneDoesWhatItSays)
{
	const Motion motion(variedRoute());
	const ImuModel perfect(motion, ImuOptions::perfect(), 4);
	const auto differs = [&](ImuOptions options, double& acc, double& gyro)
	{
		const ImuModel imu(motion, options, 4);
		acc = gyro = 0;
		for (size_t i = 0; i < imu.samples().size(); ++i)
		{
			acc = std::max(acc, (imu.samples()[i].acc_m_s2 - perfect.samples()[i].acc_m_s2).lpNorm<Eigen::Infinity>());
			gyro = std::max(gyro, (imu.samples()[i].gyro_rad_s - perfect.samples()[i].gyro_rad_s).lpNorm<Eigen::Infinity>());
		}
	};
	double acc = 0, gyro = 0;
	ImuOptions options = ImuOptions::perfect();
	options.acc_start_bias_m_s2 = 0.05;
	differs(options, acc, gyro);
	EXPECT_GT(acc, 1e-3);
	EXPECT_LE(acc, 0.05 + 1e-12);
	EXPECT_EQ(gyro, 0);

	options = ImuOptions::perfect();
	options.gyro_resolution_rad_s = 1e-3;
	differs(options, acc, gyro);
	EXPECT_EQ(acc, 0);
	EXPECT_NEAR(gyro, 0.5e-3, 0.05e-3);

	options = ImuOptions::perfect();
	options.acc_scale_error = 0.01;
	differs(options, acc, gyro);
	EXPECT_GT(acc, 1e-4);
	EXPECT_LT(acc, 0.1);
	EXPECT_EQ(gyro, 0);

	options = ImuOptions::perfect();
	options.pose_error = {0, 0, 0, 1, 0, 0};
	differs(options, acc, gyro);
	EXPECT_NEAR(acc, 9.81 * M_PI / 180, 0.05) << "one degree about the optical axis tips gravity";
}

TEST(ImuModel, JitterMovesStampsOnlyAndKeepsTheirOrder)
{
	const Motion motion(routeOf("straight 2 m"));
	ImuOptions options;
	const ImuModel steady(motion, options, 9);
	options.stamp_jitter_ms = 2;
	const ImuModel jittered(motion, options, 9);
	double worst_s = 0;
	for (size_t i = 0; i < steady.samples().size(); ++i)
	{
		EXPECT_EQ(steady.samples()[i].acc_m_s2, jittered.samples()[i].acc_m_s2);
		worst_s = std::max(worst_s, std::abs(secondsBetween(steady.samples()[i].t_ns, jittered.samples()[i].t_ns)));
		if (i > 0)
		{
			EXPECT_GT(jittered.samples()[i].t_ns, jittered.samples()[i - 1].t_ns);
		}
	}
	EXPECT_GT(worst_s, 1.8e-3);
	EXPECT_LE(worst_s, 2.0e-3);
	options.stamp_jitter_ms = 3;
	EXPECT_THROW(ImuModel(motion, options, 9), Error);
}

TEST(ImuModel, SeedDecidesAndSamplesSelectByTime)
{
	const Motion motion(routeOf("straight 2 m"));
	const ImuModel a(motion, ImuOptions(), 1), b(motion, ImuOptions(), 1), c(motion, ImuOptions(), 2);
	EXPECT_EQ(a.samples()[99].acc_m_s2, b.samples()[99].acc_m_s2);
	EXPECT_NE(a.samples()[99].acc_m_s2, c.samples()[99].acc_m_s2);
	const auto second = a.samples(1, 2);
	ASSERT_EQ(second.size(), 201u);
	EXPECT_EQ(second.front().t_ns, motion.stamp_ns(1));
	EXPECT_EQ(second.back().t_ns, motion.stamp_ns(2));
}
}  // namespace
}  // namespace viwo::sim
