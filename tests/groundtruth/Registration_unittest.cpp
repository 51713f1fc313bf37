#include "Registration.h"
#include "CorrelativeMatcher.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

using namespace viwo::gt;

namespace
{
/** The walls of a room of 6 x 4 m, seen from inside. */
Cloud room(double step_m, double noise_m, uint64_t seed, bool corridor = false)
{
	std::mt19937_64 random(seed);
	std::normal_distribution<double> normal(0, 1);
	Cloud cloud;
	const auto noise = [&] { return noise_m * normal(random); };
	for (double x = -3; x < 3; x += step_m)
	{
		cloud.push_back({{x, -2 + noise()}, {0, 1}});
		cloud.push_back({{x, 2 + noise()}, {0, -1}});
	}
	if (corridor) return cloud;
	for (double y = -2; y < 2; y += step_m)
	{
		cloud.push_back({{-3 + noise(), y}, {1, 0}});
		cloud.push_back({{3 + noise(), y}, {-1, 0}});
	}
	return cloud;
}

Cloud seenFrom(const Pose2& T, const Cloud& map)
{
	Cloud cloud;
	appendMoved(T.inverse(), map, cloud);
	return cloud;
}
}  // namespace

TEST(Registration, FindsThePose)
{
	PointIndex index;
	index.build(room(0.03, 0.01, 1), 0.16);
	const Pose2 T(0.4, -0.3, 0.2);
	const Registration r = registerCloud(seenFrom(T, room(0.05, 0.01, 2)), index, Pose2(0.3, -0.2, 0.15), nullptr, {});
	const Pose2 error = between(T, r.T);
	std::cout << "[measured] error " << error.p.norm() << " m, " << error.yaw << " rad\n";
	EXPECT_LT(error.p.norm(), 0.004);
	EXPECT_LT(std::abs(error.yaw), 0.002);
	EXPECT_GT(r.inlierRatio(), 0.95);
	EXPECT_GT(r.weakest, 0.2);
}

TEST(Registration, KnowsTheOpenDirectionOfACorridor)
{
	PointIndex index;
	index.build(room(0.03, 0.01, 1, true), 0.16);
	const PosePrior prior{Pose2(0.1, 0, 0), Eigen::Vector3d(1e2, 1e2, 1e2).asDiagonal()};
	const Registration r = registerCloud(seenFrom(Pose2(0, 0.05, 0), room(0.05, 0.01, 2, true)), index, prior.T, &prior, {});
	EXPECT_LT(r.weakest, 0.01);
	EXPECT_NEAR(std::abs(r.weakest_direction.x()), 1, 1e-3);
	EXPECT_NEAR(r.T.p.x(), 0.1, 0.02) << "the prior holds what the walls leave open";
	EXPECT_NEAR(r.T.p.y(), 0.05, 0.005);
	EXPECT_LT(r.trustedInformation(0.04)(0, 0), 1e-3 * r.information(1, 1));
}

TEST(CorrelativeMatcher, AgreesWithTryingEveryPose)
{
	const Cloud map = room(0.05, 0.01, 1);
	const CorrelativeMatcher matcher(map, 0.1, 0.1);
	const Pose2 T(0.9, -0.7, 0.3);
	const Cloud scan = seenFrom(T, room(0.2, 0.01, 2));
	const auto match = matcher.search(scan, Pose2(0, 0, 0), 1.5, 0.5, 0.3);
	ASSERT_TRUE(match.has_value());
	EXPECT_LT((match->T.p - T.p).norm(), 0.15);
	EXPECT_LT(std::abs(wrapped(match->T.yaw - T.yaw)), 0.05);
	// Windows of one cell around a grid of places: their best is the best of the whole window.
	double best = 0;
	for (double x = -1.5; x <= 1.5; x += 0.1)
		for (double y = -1.5; y <= 1.5; y += 0.1)
		{
			const auto one = matcher.search(scan, Pose2(x, y, match->T.yaw), 0, 0, 0);
			if (one) best = std::max(best, one->score);
		}
	EXPECT_NEAR(match->score, best, 0.02);
	EXPECT_FALSE(matcher.search(scan, Pose2(20, 20, 0), 0.5, 0.1, 0.3).has_value());
}
