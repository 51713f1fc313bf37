#include "EpipolarGate.h"

#include <gtest/gtest.h>
#include <viwo/core/So3.h>

#include <iostream>
#include <random>

namespace viwo
{
namespace
{
constexpr double kPixel_rad = 1.0 / 300;

struct Scene
{
	std::vector<BearingPair> pairs;
	std::vector<bool> is_outlier;
};

/** Points 1 to 8 m ahead, seen before and after the camera moves by t and turns by R; 0.3 px of noise; outliers 5 to 30 px off. */
Scene makeScene(const Eigen::Quaterniond& R, const Eigen::Vector3d& t, int inliers, int outliers, uint64_t seed)
{
	std::mt19937_64 generator(seed);
	std::uniform_real_distribution<double> uniform(-1, 1);
	std::normal_distribution<double> normal(0, 0.3 * kPixel_rad);
	Scene scene;
	for (int i = 0; i < inliers + outliers; ++i)
	{
		const Eigen::Vector3d ray(uniform(generator), 0.8 * uniform(generator), 1);
		const Eigen::Vector3d P = ray * (4.5 + 3.5 * uniform(generator));
		Eigen::Vector3d a = P.normalized(), b = (R.conjugate() * (P - t)).normalized();
		a = (a + Eigen::Vector3d(normal(generator), normal(generator), 0)).normalized();
		b = (b + Eigen::Vector3d(normal(generator), normal(generator), 0)).normalized();
		const bool outlier = i >= inliers;
		if (outlier)
		{
			const double angle = 3.14 * uniform(generator), size = (17.5 + 12.5 * uniform(generator)) * kPixel_rad;
			b = (b + size * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)).normalized();
		}
		scene.pairs.push_back({a, b});
		scene.is_outlier.push_back(outlier);
	}
	return scene;
}

struct Score
{
	double kept_inliers = 0, kept_outliers = 0;
};
Score score(const Scene& scene, const std::vector<bool>& agrees)
{
	double n_in = 0, n_out = 0;
	Score s;
	for (size_t i = 0; i < agrees.size(); ++i)
	{
		(scene.is_outlier[i] ? n_out : n_in) += 1;
		if (agrees[i]) (scene.is_outlier[i] ? s.kept_outliers : s.kept_inliers) += 1;
	}
	s.kept_inliers /= std::max(1.0, n_in);
	s.kept_outliers /= std::max(1.0, n_out);
	return s;
}

const EpipolarGateSettings kSettings{1.5 * kPixel_rad, 100, 1};

TEST(EpipolarGate, KnownRotationKeepsARigidSceneAndFewFalseMatches)
{
	const Eigen::Quaterniond R = so3::expQuaternion({0.01, 0.08, -0.02});
	for (const Eigen::Vector3d& t : {Eigen::Vector3d(0.2, 0, 0), Eigen::Vector3d(0, 0.02, 0.3), Eigen::Vector3d(0, 0, -0.3),
	                                 Eigen::Vector3d(0.015, 0, 0.0), Eigen::Vector3d(0, 0, 0.04)})
	{
		const Scene scene = makeScene(R, t, 120, 30, 5);
		const Score s = score(scene, agreeWithRotation(scene.pairs, R, kSettings));
		std::cout << "[measured] t = " << t.transpose() << ": kept " << s.kept_inliers << " of the true, " << s.kept_outliers
		          << " of the false\n";
		EXPECT_GT(s.kept_inliers, 0.97);
		EXPECT_LT(s.kept_outliers, 0.25);  // what lies along the epipolar line cannot be told
	}
}

TEST(EpipolarGate, StandingOrTurningWhateverMovesIsFalse)
{
	for (const double turn : {0.0, 0.3})
	{
		const Eigen::Quaterniond R = so3::expQuaternion({0, turn, 0});
		const Scene scene = makeScene(R, Eigen::Vector3d::Zero(), 120, 30, 6);
		const Score s = score(scene, agreeWithRotation(scene.pairs, R, kSettings));
		EXPECT_GT(s.kept_inliers, 0.97);
		EXPECT_EQ(s.kept_outliers, 0);
	}
}

TEST(EpipolarGate, PointsThatMoveTowardsTheTranslationAreFalse)
{
	const Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
	Scene scene = makeScene(R, {0.2, 0, 0}, 60, 0, 7);
	const Scene reversed = makeScene(R, {-0.2, 0, 0}, 12, 0, 8);
	for (const BearingPair& p : reversed.pairs) scene.pairs.push_back(p), scene.is_outlier.push_back(true);
	const Score s = score(scene, agreeWithRotation(scene.pairs, R, kSettings));
	EXPECT_GT(s.kept_inliers, 0.97);
	EXPECT_EQ(s.kept_outliers, 0);
}

TEST(EpipolarGate, EssentialMatrixWithoutRotation)
{
	const Eigen::Quaterniond R = so3::expQuaternion({0.01, 0.08, -0.02});
	const Scene scene = makeScene(R, {0.3, 0.05, 0.1}, 120, 30, 9);
	const std::vector<bool> agrees = agreeWithEssential(scene.pairs, kSettings);
	const Score s = score(scene, agrees);
	EXPECT_GT(s.kept_inliers, 0.95);
	EXPECT_LT(s.kept_outliers, 0.3);
	EXPECT_EQ(agrees, agreeWithEssential(scene.pairs, kSettings));
}

TEST(EpipolarGate, FewPairsAreNotJudgedWithoutEvidence)
{
	EXPECT_TRUE(agreeWithRotation({}, Eigen::Quaterniond::Identity(), kSettings).empty());
	const Scene scene = makeScene(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 3, 0, 10);
	EXPECT_EQ(agreeWithRotation(scene.pairs, Eigen::Quaterniond::Identity(), kSettings), std::vector<bool>(3, true));
	EXPECT_EQ(agreeWithEssential(scene.pairs, kSettings), std::vector<bool>(3, true));
}
}  // namespace
}  // namespace viwo
