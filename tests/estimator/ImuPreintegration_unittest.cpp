#include "ImuPreintegration.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <iostream>

#include "ImuMotion.h"

using namespace viwo;
using namespace viwo::test;

namespace
{
constexpr int64_t kMs = 1000000;
const Eigen::Vector3d kBiasA(0.08, -0.05, 0.11), kBiasG(0.01, -0.02, 0.015);

/** alpha' = beta, beta' = R a(t), R' = R [w(t)]_x by the classical Runge-Kutta rule; nothing shared with the class under test. */
ImuDelta rungeKutta(const ImuMotion& motion, double t_begin_s, double t_end_s, int steps)
{
	struct State
	{
		Eigen::Vector3d alpha, beta;
		Eigen::Matrix3d R;
	};
	const auto slope = [&](double t, const State& x) { return State{x.beta, x.R * motion.acc(t), x.R * so3::skew(motion.gyro(t))}; };
	const auto plus = [](const State& x, double h, const State& k) {
		return State{x.alpha + h * k.alpha, x.beta + h * k.beta, x.R + h * k.R};
	};
	State x{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
	const double h = (t_end_s - t_begin_s) / steps;
	for (int i = 0; i < steps; ++i)
	{
		const double t = t_begin_s + i * h;
		const State k1 = slope(t, x), k2 = slope(t + h / 2, plus(x, h / 2, k1)), k3 = slope(t + h / 2, plus(x, h / 2, k2));
		const State k4 = slope(t + h, plus(x, h, k3));
		x = plus(plus(plus(plus(x, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
	}
	return {x.alpha, x.beta, Eigen::Quaterniond(x.R).normalized()};
}

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
	return (a - b).norm() / b.norm();
}

void expectSame(const ImuPreintegration& a, const ImuPreintegration& b, double bar)
{
	EXPECT_NEAR(a.dt_s(), b.dt_s(), bar);
	const double delta = difference(a.delta(), b.delta()).norm();
	const double jacobian = relative(a.biasJacobian(), b.biasJacobian()), covariance = relative(a.covariance(), b.covariance());
	std::cout << "[measured] delta " << delta << ", bias Jacobian " << jacobian << ", covariance " << covariance << " (relative)\n";
	EXPECT_LE(delta, bar);
	EXPECT_LE(jacobian, bar);
	EXPECT_LE(covariance, bar);
	ASSERT_EQ(a.samples().size(), b.samples().size());
	for (size_t i = 0; i < a.samples().size(); ++i) EXPECT_EQ(a.samples()[i].t_ns, b.samples()[i].t_ns);
}
}  // namespace

TEST(ImuPreintegration, ConvergesAtSecondOrderToFineIntegration)
{
	const ImuMotion motion;
	const ImuDelta truth = rungeKutta(motion, 0.0123, 0.5123, 5000);
	double previous = 0;
	for (const int64_t period_ms : {10, 5})  // 100 and 200 Hz; ends between samples
	{
		const ImuPreintegration p = preintegrated(sampled(motion, period_ms * kMs, 600 * kMs), 12300000, 512300000);
		const Eigen::Matrix<double, 9, 1> e = difference(p.delta(), truth);
		std::cout << "[measured] over 0.5 s at " << 1000 / period_ms << " Hz: position " << e.head<3>().norm() << " m, rotation "
		          << e.segment<3>(3).norm() << " rad, velocity " << e.tail<3>().norm() << " m/s\n";
		if (previous > 0)
		{
			EXPECT_LT(e.norm(), previous / 3.6);
		}
		previous = e.norm();
	}
	EXPECT_LT(previous, 5e-5);
}

TEST(ImuPreintegration, ConstantTurnIsExactWhateverTheStep)
{
	const Eigen::Vector3d acc(0.3, 0.8, 9.81), gyro(0.1, -0.2, 1.5);
	const auto integrated = [&](int steps)
	{
		std::vector<ImuSample> span;
		for (int i = 0; i <= steps; ++i) span.push_back({i * 500 * kMs / steps, acc, gyro});
		ImuPreintegration p({}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
		p.integrate(span);
		return p.delta();
	};
	const double error = difference(integrated(1), integrated(100)).norm();
	std::cout << "[measured] one step against a hundred " << error << "\n";
	EXPECT_LT(error, 1e-13);
}

TEST(ImuPreintegration, StandingStillLiftsByGravityOnly)
{
	std::vector<ImuSample> span;
	for (int i = 0; i <= 40; ++i) span.push_back({i * 5 * kMs, {0, 0, 9.81}, {0, 0, 0}});
	ImuPreintegration p({}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
	p.integrate(span);
	EXPECT_NEAR(p.dt_s(), 0.2, 1e-15);
	EXPECT_NEAR(p.delta().beta.z(), 9.81 * 0.2, 1e-13);
	EXPECT_NEAR(p.delta().alpha.z(), 0.5 * 9.81 * 0.04, 1e-13);
	EXPECT_EQ(p.t_begin_ns(), 0);
	EXPECT_EQ(p.t_end_ns(), 200 * kMs);
}

TEST(ImuPreintegration, BiasJacobianAgreesWithNumeric)
{
	double worst = 0;
	for (const double rate : {0., 1e-6, 1., 5.})
	{
		const ImuBuffer buffer = sampled(ImuMotion{rate}, 5 * kMs, 500 * kMs);
		const ImuPreintegration p = preintegrated(buffer, 12 * kMs, 412 * kMs, {}, kBiasA, kBiasG);
		Eigen::Matrix<double, 9, 6> numeric;
		for (int i = 0; i < 6; ++i)
		{
			const double step = 1e-3;
			Eigen::Matrix<double, 6, 1> d = Eigen::Matrix<double, 6, 1>::Unit(i) * step;
			ImuPreintegration plus = p, minus = p;
			plus.repropagate(kBiasA + d.head<3>(), kBiasG + d.tail<3>());
			minus.repropagate(kBiasA - d.head<3>(), kBiasG - d.tail<3>());
			// Through the manifold at p, so that the rotation is the right perturbation of p's.
			numeric.col(i) = (difference(plus.delta(), p.delta()) - difference(minus.delta(), p.delta())) / (2 * step);
		}
		for (int r = 0; r < 9; r += 3)
		{
			for (int c = 0; c < 6; c += 3)
			{
				const Eigen::Matrix3d n = numeric.block<3, 3>(r, c);
				const Eigen::Matrix3d analytic = p.biasJacobian().block<3, 3>(r, c);
				// The accelerometer turns nothing.
				worst = std::max(worst, r == 3 && c == 0 ? analytic.norm() : relative(analytic, n));
			}
		}
	}
	std::cout << "[measured] bias Jacobian against numeric, worst 3x3 block, relative " << worst << "\n";
	EXPECT_LT(worst, 1e-6);
}

TEST(ImuPreintegration, CorrectionIsOfFirstOrder)
{
	const ImuBuffer buffer = sampled(ImuMotion{}, 5 * kMs, 500 * kMs);
	const ImuPreintegration p = preintegrated(buffer, 0, 400 * kMs);
	EXPECT_EQ(difference(p.corrected(p.b_a(), p.b_g()), p.delta()).norm(), 0);
	double previous = 0;
	for (const double scale : {1., 0.5})
	{
		ImuPreintegration fresh = p;
		fresh.repropagate(scale * kBiasA, scale * kBiasG);
		const double error = difference(p.corrected(scale * kBiasA, scale * kBiasG), fresh.delta()).norm();
		std::cout << "[measured] error of the first-order correction, bias x " << scale << ": " << error << "\n";
		if (previous > 0)
		{
			EXPECT_NEAR(previous / error, 4, 0.1);
		}
		previous = error;
	}
}

TEST(ImuPreintegration, AppendEqualsOneGo)
{
	const ImuBuffer buffer = sampled(ImuMotion{2}, 5 * kMs, 1000 * kMs);
	ImuNoise noise;
	noise.gyro_walk_rad_s2_sqrtHz = 0.1;
	noise.acc_walk_m_s3_sqrtHz = 0.5;
	const int64_t cuts_ns[] = {12345678, 111111111, 203000000, 431234567};
	ImuPreintegration joined(noise, kBiasA, kBiasG), one_go(noise, kBiasA, kBiasG);
	for (int i = 0; i < 3; ++i)
	{
		joined.append(preintegrated(buffer, cuts_ns[i], cuts_ns[i + 1], noise, kBiasA, kBiasG));
		one_go.integrate(buffer.span(cuts_ns[i], cuts_ns[i + 1], 1).value());
	}
	expectSame(joined, one_go, 1e-12);
	EXPECT_EQ(joined.t_begin_ns(), cuts_ns[0]);
	EXPECT_EQ(joined.t_end_ns(), cuts_ns[3]);
}

TEST(ImuPreintegration, RepropagationEqualsAFreshStart)
{
	const ImuBuffer buffer = sampled(ImuMotion{2}, 5 * kMs, 500 * kMs);
	ImuPreintegration p = preintegrated(buffer, 3 * kMs, 401 * kMs);
	p.repropagate(kBiasA, kBiasG);
	expectSame(p, preintegrated(buffer, 3 * kMs, 401 * kMs, {}, kBiasA, kBiasG), 0);
	EXPECT_EQ(p.b_a(), kBiasA);
	EXPECT_EQ(p.b_g(), kBiasG);
}

TEST(ImuPreintegration, CovarianceIsSymmetricAndInvertible)
{
	const ImuBuffer buffer = sampled(ImuMotion{}, 5 * kMs, 3000 * kMs);
	for (const int64_t t_end_ms : {4, 100, 3000})
	{
		const ImuPreintegration::Covariance S = preintegrated(buffer, 0, t_end_ms * kMs).covariance();
		EXPECT_LT((S - S.transpose()).norm(), 1e-14 * S.norm());
		const Eigen::Matrix<double, 15, 1> scale = S.diagonal().cwiseSqrt().cwiseInverse();
		const ImuPreintegration::Covariance correlation = scale.asDiagonal() * S * scale.asDiagonal();
		const double smallest = Eigen::SelfAdjointEigenSolver<ImuPreintegration::Covariance>(correlation).eigenvalues()(0);
		std::cout << "[measured] over " << t_end_ms << " ms: smallest eigenvalue of the correlation matrix " << smallest << "\n";
		EXPECT_GT(smallest, 1e-6);
	}
}
