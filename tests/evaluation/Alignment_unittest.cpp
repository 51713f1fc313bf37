#include "RandomTrajectory.h"

#include <viwo/core/Error.h>
#include <viwo/evaluation/Alignment.h>

#include <gtest/gtest.h>

using namespace viwo;
using namespace viwo::testing;

namespace
{
std::vector<Pose3> posesOf(const Trajectory& t)
{
	std::vector<Pose3> poses;
	for (const auto& p : t.poses()) poses.push_back(p.T);
	return poses;
}

double sumOfSquares(const Similarity& s, const std::vector<Pose3>& ref, const std::vector<Pose3>& est)
{
	double sum = 0;
	for (size_t i = 0; i < ref.size(); ++i) sum += ((s * est[i]).p - ref[i].p).squaredNorm();
	return sum;
}

struct NoisyPair
{
	std::vector<Pose3> ref, est;
};

NoisyPair noisyPair(uint64_t seed, double scale)
{
	std::mt19937_64 random(seed);
	NoisyPair pair{posesOf(windingDrive(5, 30)), {}};
	const Pose3 T = randomPose(random, 3, 1);
	for (const Pose3& pose : pair.ref)
	{
		Pose3 est = T * pose * randomPose(random, 0.05, 0.02);
		est.p *= scale;
		pair.est.push_back(est);
	}
	return pair;
}
}  // namespace

TEST(Alignment, RemovesKnownTransformExactly)
{
	const auto ref = posesOf(windingDrive(10, 20));
	std::mt19937_64 random(1);
	for (int trial = 0; trial < 20; ++trial)
	{
		const Pose3 T = randomPose(random, 10, 2);
		std::vector<Pose3> est;
		for (const auto& pose : ref) est.push_back(T * pose);
		const Similarity s = align(AlignmentKind::se3, ref, est);
		for (size_t i = 0; i < ref.size(); ++i)
		{
			EXPECT_LT(((s * est[i]).p - ref[i].p).norm(), 1e-11);
			EXPECT_LT((s * est[i]).R.angularDistance(ref[i].R), 1e-7);
		}
		EXPECT_EQ(s.scale, 1);
	}
}

TEST(Alignment, Sim3FindsScale)
{
	const auto ref = posesOf(windingDrive(10, 20));
	std::mt19937_64 random(2);
	const Pose3 T = randomPose(random, 10, 2);
	std::vector<Pose3> est;
	for (const auto& pose : ref)
	{
		Pose3 moved = T * pose;
		moved.p /= 1.7;
		est.push_back(moved);
	}
	EXPECT_NEAR(align(AlignmentKind::sim3, ref, est).scale, 1.7, 1e-12);
	EXPECT_LT(sumOfSquares(align(AlignmentKind::sim3, ref, est), ref, est), 1e-20);
	EXPECT_GT(sumOfSquares(align(AlignmentKind::se3, ref, est), ref, est), 1);
}

TEST(Alignment, YawLeavesTilt)
{
	const auto ref = posesOf(windingDrive(10, 20));
	const Pose3 turned(Eigen::Quaterniond(Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(4, -2, 1));
	const Pose3 tilted(Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX())), Eigen::Vector3d::Zero());
	std::vector<Pose3> only_turned, also_tilted;
	for (const auto& pose : ref)
	{
		only_turned.push_back(turned * pose);
		also_tilted.push_back(turned * tilted * pose);
	}
	EXPECT_LT(sumOfSquares(align(AlignmentKind::yaw, ref, only_turned), ref, only_turned), 1e-20);
	EXPECT_LT(sumOfSquares(align(AlignmentKind::se3, ref, also_tilted), ref, also_tilted), 1e-20);
	EXPECT_GT(sumOfSquares(align(AlignmentKind::yaw, ref, also_tilted), ref, also_tilted), 0.1);
}

// No small rotation, shift or change of scale that the kind allows may do better than the closed form.
TEST(Alignment, IsAMinimum)
{
	for (const AlignmentKind kind : {AlignmentKind::se3, AlignmentKind::yaw, AlignmentKind::sim3})
	{
		const NoisyPair pair = noisyPair(3, 1.3);
		const Similarity best = align(kind, pair.ref, pair.est);
		const double least = sumOfSquares(best, pair.ref, pair.est);
		std::mt19937_64 random(4);
		for (int trial = 0; trial < 300; ++trial)
		{
			Similarity s = best;
			Eigen::Vector3d phi = randomVector(random, 3e-3);
			if (kind == AlignmentKind::yaw) phi.x() = phi.y() = 0;
			s.T_ref_est.R = Eigen::Quaterniond(Eigen::AngleAxisd(phi.norm(), phi.normalized())) * s.T_ref_est.R;
			s.T_ref_est.p += randomVector(random, 3e-3);
			if (kind == AlignmentKind::sim3) s.scale *= 1 + randomVector(random, 3e-3).x();
			EXPECT_GT(sumOfSquares(s, pair.ref, pair.est), least) << toString(kind);
		}
	}
}

TEST(Alignment, OrientationsWeighNothingToSpeakOf)
{
	NoisyPair pair = noisyPair(5, 1);
	const double with = sumOfSquares(align(AlignmentKind::se3, pair.ref, pair.est), pair.ref, pair.est);
	std::mt19937_64 random(6);
	for (auto& pose : pair.est) pose.R = randomPose(random, 1, 2).R;
	const double scrambled = sumOfSquares(align(AlignmentKind::se3, pair.ref, pair.est), pair.ref, pair.est);
	EXPECT_NEAR(scrambled / with, 1, 1e-6);
}

// Positions on a straight line leave the rotation about it open.
TEST(Alignment, OrientationsSettleAStraightLine)
{
	std::vector<Pose3> ref, est;
	const Pose3 T(Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized())), Eigen::Vector3d(1, 2, 3));
	for (int i = 0; i < 50; ++i)
	{
		ref.emplace_back(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.1 * i, 0, 0));
		est.push_back(T * ref.back());
	}
	const Similarity s = align(AlignmentKind::se3, ref, est);
	for (size_t i = 0; i < ref.size(); ++i) EXPECT_LT((s * est[i]).R.angularDistance(ref[i].R), 1e-6);
	const std::vector<Pose3> still(10, ref[0]), still_moved(10, est[0]);
	EXPECT_LT((align(AlignmentKind::se3, still, still_moved) * est[0]).R.angularDistance(ref[0].R), 1e-6);
}

TEST(Alignment, NamesRoundTrip)
{
	for (const AlignmentKind kind : {AlignmentKind::se3, AlignmentKind::yaw, AlignmentKind::none, AlignmentKind::sim3})
		EXPECT_EQ(alignmentFromString(toString(kind)), kind);
	EXPECT_THROW(alignmentFromString("SE3"), Error);
}
