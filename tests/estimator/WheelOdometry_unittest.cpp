#include <WheelOdometry.h>

#include <viwo/core/So3.h>

#include <CovarianceComparison.h>
#include <WheelPreintegration.h>
#include <gtest/gtest.h>

namespace viwo
{
namespace
{
using test::monteCarloBar;
using test::monteCarloDraws;

constexpr double kSegment_s = 0.05;
constexpr int kSegments = 60, kSegmentsAnInterval = 2;

/** A curve of three seconds: twenty samples a second, two an interval. */
WheelSegment segmentOf(int i)
{
	const double v = 0.3 + 0.1 * std::sin(0.2 * i), w = 0.5 * std::cos(0.1 * i);
	const WheelSample s = wheelSampleFromTwist(0, {v, w}, 0.23);
	return {kSegment_s, s.v_left_m_s, s.v_right_m_s};
}

Pose3 drive(WheelOdometry& odometry, const EstimatorOptions& options, const WheelIntrinsics& k, test::UnitErrors* errors)
{
	const WheelNoise& n = options.noise.wheels;
	odometry.reset(0, Pose3());
	for (int i = 0; i < kSegments; i += kSegmentsAnInterval)
	{
		WheelPreintegration interval(n, k);
		for (int j = i; j < i + kSegmentsAnInterval; ++j)
		{
			WheelSegment s = segmentOf(j);
			if (errors)
				for (double* v : {&s.v_left_m_s, &s.v_right_m_s})
					*v += std::hypot(n.s0_m_s_sqrtHz, n.k_sqrtHz * *v) / std::sqrt(kSegment_s) * (*errors)();
			interval.integrate(s);
		}
		odometry.add(interval);
	}
	return odometry.T_WO();
}

EstimatorOptions narrowFloors()
{
	EstimatorOptions options;
	options.mode = Mode::wheel;
	options.noise.wheels.lateral_m_s_sqrtHz = options.noise.wheels.vertical_m_s_sqrtHz = options.noise.wheels.tilt_rad_s_sqrtHz = 1e-6;
	return options;
}

TEST(WheelOdometry, ChainOfIntervalsIsOneInterval)
{
	const EstimatorOptions options = narrowFloors();
	const WheelIntrinsics k{1, 1, 0.23};
	WheelOdometry odometry(options, k);
	const Pose3 T_WO = drive(odometry, options, k, nullptr);
	WheelPreintegration whole(options.noise.wheels, k);
	for (int i = 0; i < kSegments; ++i) whole.integrate(segmentOf(i));
	EXPECT_LT((T_WO.p - whole.dp()).norm(), 1e-12);
	EXPECT_LT(so3::log(T_WO.R.conjugate() * whole.dR()).norm(), 1e-12);
	const Eigen::Vector3d sigma(options.priors.wheel_scale, options.priors.wheel_scale, options.priors.track_relative * k.track_m);
	const Eigen::Matrix<double, 6, 3> J = whole.intrinsicsJacobian() * sigma.asDiagonal();
	const Eigen::Matrix<double, 6, 6> expected = whole.covariance() + J * J.transpose();
	EXPECT_LT((odometry.covariance() - expected).norm() / expected.norm(), 1e-9);
}

TEST(WheelOdometry, CovarianceAgainstDraws)
{
	EstimatorOptions options = narrowFloors();
	// Small enough for a first-order model.
	options.priors.wheel_scale = options.priors.track_relative = 0.003;
	options.noise.wheels.s0_m_s_sqrtHz = 3e-4;
	options.noise.wheels.k_sqrtHz = 6e-3;
	const WheelIntrinsics k{1, 1, 0.23};
	WheelOdometry odometry(options, k);
	const Pose3 nominal = drive(odometry, options, k, nullptr);
	const Eigen::Matrix<double, 6, 6> model = odometry.covariance();

	test::UnitErrors errors(11);
	test::SampleCovariance<3> drawn;
	const PriorOptions& p = options.priors;
	for (int i = 0; i < monteCarloDraws(20000); ++i)
	{
		const WheelIntrinsics true_k{1 + p.wheel_scale * errors(), 1 + p.wheel_scale * errors(), 0.23 * (1 + p.track_relative * errors())};
		const Pose3 T = drive(odometry, options, true_k, &errors);
		drawn.add({T.p.x() - nominal.p.x(), T.p.y() - nominal.p.y(), so3::log(nominal.R.conjugate() * T.R).z()});
	}
	Eigen::Matrix3d planar;
	const int rows[] = {0, 1, 5};
	for (int r = 0; r < 3; ++r)
		for (int c = 0; c < 3; ++c) planar(r, c) = model(rows[r], rows[c]);
	const auto difference = test::compareCovariances<3>(planar, drawn.value());
	std::cout << "[measured] x, y, yaw: " << difference << "\n";
	EXPECT_LT(difference.worst(), monteCarloBar(0.05));
}

TEST(WheelOdometry, ResetForgets)
{
	const EstimatorOptions options = narrowFloors();
	WheelOdometry odometry(options, {1, 1, 0.23});
	drive(odometry, options, {1, 1, 0.23}, nullptr);
	EXPECT_GT(odometry.covariance().norm(), 0);
	const Pose3 T(so3::expQuaternion({0, 0, 1}), Eigen::Vector3d(1, 2, 0));
	odometry.reset(0, T);
	EXPECT_EQ(odometry.T_WO().p, T.p);
	EXPECT_EQ(odometry.covariance().norm(), 0);
}
}  // namespace
}  // namespace viwo
