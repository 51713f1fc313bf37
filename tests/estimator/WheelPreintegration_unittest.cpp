#include "WheelPreintegration.h"

#include <gtest/gtest.h>
#include <viwo/core/So3.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iostream>

using namespace viwo;

namespace
{
using Vector6 = Eigen::Matrix<double, 6, 1>;

/** 20 Hz, turning one way and the other, with a reversal and a rotation in place. */
const std::vector<WheelSegment> kDrive{{0.05, 0.10, 0.20}, {0.05, 0.15, 0.15},  {0.02, 0.20, 0.05},
                                       {0.03, 0.20, 0.05}, {0.05, -0.10, 0.10}, {0.05, -0.2, -0.15}};

WheelPreintegration preintegrated(const std::vector<WheelSegment>& segments, const WheelIntrinsics& at = {})
{
	WheelPreintegration p({}, at);
	for (const WheelSegment& s : segments) p.integrate(s);
	return p;
}

Vector6 difference(const Pose3& to, const Pose3& from)
{
	Vector6 d;
	d << to.p - from.p, so3::log(Eigen::Quaterniond(from.R.conjugate() * to.R));
	return d;
}

Pose3 deltaOf(const WheelPreintegration& p)
{
	return {p.dR(), p.dp()};
}

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
	return (a - b).norm() / b.norm();
}

void expectSame(const WheelPreintegration& a, const WheelPreintegration& b, double bar)
{
	const double delta = difference(deltaOf(a), deltaOf(b)).norm();
	const double covariance = relative(a.covariance(), b.covariance()), jacobian = relative(a.intrinsicsJacobian(), b.intrinsicsJacobian());
	std::cout << "[measured] delta " << delta << ", covariance " << covariance << ", intrinsics Jacobian " << jacobian << " (relative)\n";
	EXPECT_LE(delta, bar);
	EXPECT_LE(covariance, bar);
	EXPECT_LE(jacobian, bar);
	EXPECT_NEAR(a.dt_s(), b.dt_s(), bar);
	EXPECT_NEAR(a.distance_m(), b.distance_m(), bar);
	EXPECT_EQ(a.segments().size(), b.segments().size());
}
}  // namespace

TEST(WheelPreintegration, AnArcIsExact)
{
	double worst = 0;
	// Straight, barely turning, a metre's radius, tight, on the spot, backwards.
	for (const auto& [v, w] : {std::pair{0.15, 0.}, {0.15, 1e-9}, {0.15, 1e-4}, {0.15, 0.15}, {0.1, -3.}, {0., 2.}, {-0.2, 0.7}})
	{
		const WheelSample speeds = wheelSampleFromTwist(0, {v, w}, WheelIntrinsics{}.track_m);
		std::vector<WheelSegment> segments;
		for (int i = 0; i < 40; ++i) segments.push_back({i % 3 ? 0.05 : 0.02, speeds.v_left_m_s, speeds.v_right_m_s});
		const WheelPreintegration p = preintegrated(segments);
		const double t = p.dt_s();
		// v sin(wt)/w and v (1 - cos(wt))/w without cancellation.
		const double chord = w == 0 ? v * t : 2 * v / w * std::sin(w * t / 2);
		const Eigen::Vector3d end(chord * std::cos(w * t / 2), chord * std::sin(w * t / 2), 0);
		const Pose3 truth(Eigen::Quaterniond(Eigen::AngleAxisd(w * t, Eigen::Vector3d::UnitZ())), end);
		worst = std::max(worst, (p.dp() - end).norm());
		worst = std::max(worst, so3::log(Eigen::Quaterniond(truth.R.conjugate() * p.dR())).norm());
		EXPECT_NEAR(p.distance_m(), std::abs(v) * t, 1e-14);
	}
	std::cout << "[measured] arcs of 40 segments against the closed form " << worst << "\n";
	EXPECT_LT(worst, 1e-14);
}

TEST(WheelPreintegration, SplittingASegmentChangesNeitherArcNorIntrinsicsJacobian)
{
	const WheelPreintegration whole = preintegrated({{0.05, 0.1, 0.3}}), split = preintegrated({{0.013, 0.1, 0.3}, {0.037, 0.1, 0.3}});
	EXPECT_LT(difference(deltaOf(whole), deltaOf(split)).norm(), 1e-16);
	EXPECT_LT(relative(split.intrinsicsJacobian(), whole.intrinsicsJacobian()), 1e-14);
	// White in time: the pieces carry the yaw noise of the whole.
	EXPECT_NEAR(split.covariance()(5, 5) / whole.covariance()(5, 5), 1, 1e-14);
}

TEST(WheelPreintegration, SegmentsWithoutDurationAreIgnored)
{
	const WheelPreintegration p = preintegrated({{0, 1, 1}, {-0.1, 1, 1}});
	EXPECT_TRUE(p.segments().empty());
	EXPECT_EQ(p.dp().norm(), 0);
	EXPECT_EQ(p.covariance().norm(), 0);
}

TEST(WheelPreintegration, IntrinsicsJacobianAgreesWithNumeric)
{
	const std::vector<std::vector<WheelSegment>> drives{
	    kDrive, {{0.05, 0.15, 0.15}}, {{0.05, -0.1, 0.1}, {0.05, -0.1, 0.1}}, {{0.05, 1e-6, 2e-6}}};
	double worst = 0;
	for (const auto& segments : drives)
	{
		for (const WheelIntrinsics& at : {WheelIntrinsics{}, WheelIntrinsics{0.97, 1.02, 0.31}})
		{
			const WheelPreintegration p = preintegrated(segments, at);
			WheelPreintegration::IntrinsicsJacobian numeric;
			for (int i = 0; i < 3; ++i)
			{
				const double step = 1e-5;
				WheelIntrinsics plus = at, minus = at;
				(i == 0 ? plus.k_left : i == 1 ? plus.k_right : plus.track_m) += step;
				(i == 0 ? minus.k_left : i == 1 ? minus.k_right : minus.track_m) -= step;
				numeric.col(i) = (difference(deltaOf(preintegrated(segments, plus)), deltaOf(p)) -
				                  difference(deltaOf(preintegrated(segments, minus)), deltaOf(p))) /
				                 (2 * step);
			}
			worst = std::max(worst, relative(p.intrinsicsJacobian(), numeric));
		}
	}
	std::cout << "[measured] intrinsics Jacobian against numeric, relative " << worst << "\n";
	EXPECT_LT(worst, 1e-6);
}

TEST(WheelPreintegration, CorrectionIsOfFirstOrder)
{
	const WheelPreintegration p = preintegrated(kDrive);
	EXPECT_EQ(difference(p.corrected(p.intrinsics()), deltaOf(p)).norm(), 0);
	double previous = 0;
	for (const double scale : {1., 0.5})
	{
		const WheelIntrinsics k{1 + 0.01 * scale, 1 - 0.008 * scale, 0.23 + 0.002 * scale};
		const double error = difference(p.corrected(k), deltaOf(preintegrated(kDrive, k))).norm();
		std::cout << "[measured] error of the first-order correction, change x " << scale << ": " << error << "\n";
		if (previous > 0)
		{
			EXPECT_NEAR(previous / error, 4, 0.1);
		}
		previous = error;
	}
}

TEST(WheelPreintegration, AppendEqualsOneGo)
{
	for (size_t cut = 0; cut <= kDrive.size(); ++cut)
	{
		WheelPreintegration joined = preintegrated({kDrive.begin(), kDrive.begin() + static_cast<std::ptrdiff_t>(cut)}, {1.01, 0.99, 0.25});
		joined.append(preintegrated({kDrive.begin() + static_cast<std::ptrdiff_t>(cut), kDrive.end()}, {1.01, 0.99, 0.25}));
		expectSame(joined, preintegrated(kDrive, {1.01, 0.99, 0.25}), 1e-12);
	}
}

TEST(WheelPreintegration, RepropagationEqualsAFreshStart)
{
	WheelPreintegration p = preintegrated(kDrive);
	p.repropagate({1.02, 0.97, 0.24});
	expectSame(p, preintegrated(kDrive, {1.02, 0.97, 0.24}), 0);
	EXPECT_EQ(p.intrinsics().track_m, 0.24);
}

TEST(WheelPreintegration, CovarianceIsInvertibleInEveryMotion)
{
	const std::vector<std::vector<WheelSegment>> drives{{{0.004, 0, 0}},
	                                                    {{0.05, 0, 0}, {0.05, 0, 0}},
	                                                    {{0.05, 0.15, 0.15}, {0.05, 0.15, 0.15}},
	                                                    {{0.05, -0.2, 0.2}},
	                                                    {{0.05, -0.1, 0.3}, {0.05, -0.1, 0.3}}};
	for (const auto& segments : drives)
	{
		const WheelPreintegration::Covariance S = preintegrated(segments).covariance();
		EXPECT_LT((S - S.transpose()).norm(), 1e-14 * S.norm());
		const Vector6 scale = S.diagonal().cwiseSqrt().cwiseInverse();
		const WheelPreintegration::Covariance correlation = scale.asDiagonal() * S * scale.asDiagonal();
		const double smallest = Eigen::SelfAdjointEigenSolver<WheelPreintegration::Covariance>(correlation).eigenvalues()(0);
		std::cout << "[measured] smallest eigenvalue of the correlation matrix " << smallest << "\n";
		EXPECT_GT(smallest, 1e-3);
	}
}
