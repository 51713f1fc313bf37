#include <gtest/gtest.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>
#include <viwo/sfm/StructureFromMotion.h>

#include <Eigen/Eigenvalues>
#include <chrono>
#include <functional>
#include <iostream>

#include "PointScene.h"

namespace viwo
{
namespace
{
using test::PointScene;
constexpr double kPixel_rad = 1.0 / 300;
using Path = std::function<Pose3(double)>;

/** Camera poses in a corridor along x, 11 frames in one second. */
Pose3 lookingAlongX(double yaw_rad, const Eigen::Vector3d& p)
{
	return {so3::expQuaternion({0, 0, yaw_rad}) * forwardOpticalAxes(), p};
}
const Path kForward = [](double t) { return lookingAlongX(0, {0.2 * t, 0, 0}); };
const Path kArc = [](double t) { return lookingAlongX(0.3 * t, {0.25 * t, 0.04 * t * t, 0.005 * std::sin(9 * t)}); };
const Path kSideways = [](double t) { return lookingAlongX(0.02 * t, {0, 0.3 * t, 0}); };
const Path kTurn = [](double t) { return lookingAlongX(0.4 * t, {0, 0, 0}); };
const Path kStand = [](double) { return lookingAlongX(0, {0, 0, 0}); };

struct Window
{
	std::vector<Pose3> T_WC;
	std::vector<FeatureFrame> frames;
	std::vector<Eigen::Quaterniond> prior;  //!< with the error of a gyroscope bias
};

Window makeWindow(const Path& path, const PointScene::Noise& noise = {}, int n = 11)
{
	static const PointScene corridor({-2, -1.2, -0.5}, {9, 1.2, 1.5}, 300, 0.4, 3);
	Window w;
	for (int k = 0; k < n; ++k)
	{
		const double t = 0.1 * k;
		w.T_WC.push_back(path(t));
		w.frames.push_back(corridor.observe(nanoseconds(t), w.T_WC.back(), noise));
		w.prior.push_back(w.T_WC.front().R.conjugate() * w.T_WC.back().R * so3::expQuaternion(Eigen::Vector3d(0.01, -0.015, 0.01) * t));
	}
	return w;
}

struct Errors
{
	double rotation_rad = 0, direction_rad = 0, position_relative = 0;  //!< largest over the frames; position after fitting the one scale
};

Errors errorsOf(const SfmResult& result, const Window& w)
{
	Eigen::VectorXd truth(3 * w.T_WC.size()), estimate(3 * w.T_WC.size());
	Errors e;
	for (size_t k = 0; k < w.T_WC.size(); ++k)
	{
		const Pose3 T = w.T_WC.front().inverse() * w.T_WC[k];
		e.rotation_rad = std::max(e.rotation_rad, so3::log(T.R.conjugate() * result.T_c0_ck[k].R).norm());
		truth.segment<3>(3 * static_cast<Eigen::Index>(k)) = T.p;
		estimate.segment<3>(3 * static_cast<Eigen::Index>(k)) = result.T_c0_ck[k].p;
	}
	const Eigen::Vector3d a = truth.tail<3>().normalized(), b = estimate.tail<3>().normalized();
	e.direction_rad = std::atan2(a.cross(b).norm(), a.dot(b));
	const double scale = truth.dot(estimate) / estimate.squaredNorm();
	e.position_relative = (scale * estimate - truth).lpNorm<Eigen::Infinity>() / truth.tail<3>().norm();
	return e;
}

TEST(StructureFromMotion, ExactOnExactTracks)
{
	for (const Path& path : {kForward, kArc, kSideways})
	{
		const Window w = makeWindow(path);
		const SfmResult result = StructureFromMotion(SfmOptions()).reconstruct(w.frames);
		ASSERT_EQ(result.status, SfmStatus::ok) << toString(result.status);
		const Errors e = errorsOf(result, w);
		std::cout << "[measured] exact tracks: rotation " << e.rotation_rad << " rad, direction " << e.direction_rad << " rad, position "
		          << e.position_relative << " of the path; parallax " << result.parallax_rad << " rad, " << result.points.size()
		          << " points\n";
		EXPECT_LT(e.rotation_rad, 1e-6);
		EXPECT_LT(e.direction_rad, 1e-6);
		EXPECT_LT(e.position_relative, 1e-6);
		EXPECT_LT(result.rms_rad, 1e-8);
		const double scale = (w.T_WC.front().inverse() * w.T_WC.back()).p.norm() / result.T_c0_ck.back().p.norm();
		for (const SfmPoint& point : result.points)
		{
			const Eigen::Vector3d expected =
			    w.T_WC.front().inverse() * PointScene({-2, -1.2, -0.5}, {9, 1.2, 1.5}, 300, 0.4, 3).points_W[point.id];
			ASSERT_LT((scale * point.p_c0 - expected).norm(), 1e-4 * expected.norm());
		}
	}
}

TEST(StructureFromMotion, FineWithHalfAPixelOfNoiseAndItsCovarianceIsRight)
{
	for (const Path& path : {kForward, kArc, kSideways})
	{
		double chi2 = 0, dof = 0, worst = 0, worst_rotation = 0, worst_direction = 0;
		for (uint64_t seed = 1; seed <= 10; ++seed)
		{
			const Window w = makeWindow(path, {0.5 * kPixel_rad, 0, seed * 1000003});
			SfmOptions options;
			options.sigma_rad = 0.5 * kPixel_rad;
			const SfmResult result = StructureFromMotion(options).reconstruct(w.frames, w.prior);
			ASSERT_EQ(result.status, SfmStatus::ok) << toString(result.status);
			const Errors e = errorsOf(result, w);
			worst = std::max(worst, e.position_relative);
			worst_rotation = std::max(worst_rotation, e.rotation_rad);
			worst_direction = std::max(worst_direction, e.direction_rad);

			// Scale so that the pair which fixes the scale has its true distance, as the covariance is conditioned on that.
			const size_t r = static_cast<size_t>(result.reference);
			const double scale = (w.T_WC.back().p - w.T_WC[r].p).norm() / (result.T_c0_ck.back().p - result.T_c0_ck[r].p).norm();
			Eigen::VectorXd error(60);
			for (Eigen::Index k = 0; k < 10; ++k)
			{
				const auto i = static_cast<size_t>(k);
				const Pose3 truth = w.T_WC[i].inverse() * w.T_WC[i + 1], est = result.T_c0_ck[i].inverse() * result.T_c0_ck[i + 1];
				error.segment<3>(6 * k) = est.p - truth.p / scale;
				error.segment<3>(6 * k + 3) = so3::log(truth.R.conjugate() * est.R);
			}
			// Rank 59: the scale is fixed. What lies in the null space is left out.
			const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(result.interval_covariance);
			const Eigen::VectorXd z = eigen.eigenvectors().rightCols(59).transpose() * error;
			chi2 += z.cwiseAbs2().cwiseQuotient(eigen.eigenvalues().tail(59)).sum();
			dof += 59;
		}
		std::cout << "[measured] 0.5 px: worst of 10: rotation " << worst_rotation << " rad, direction " << worst_direction
		          << " rad, position " << worst << " of the path; chi2/dof of the intervals " << chi2 / dof << "\n";
		EXPECT_LT(worst_rotation, 5e-3);
		EXPECT_LT(worst, 0.1);
		EXPECT_GT(chi2 / dof, 0.75);
		EXPECT_LT(chi2 / dof, 1.3);
	}
}

TEST(StructureFromMotion, RotationAndStandstillHaveNoParallax)
{
	for (const Path& path : {kTurn, kStand})
		for (const double sigma : {0.0, 0.5 * kPixel_rad})
		{
			const Window w = makeWindow(path, {sigma, 0, 5});
			EXPECT_EQ(StructureFromMotion(SfmOptions()).reconstruct(w.frames).status, SfmStatus::not_enough_parallax);
			EXPECT_EQ(StructureFromMotion(SfmOptions()).reconstruct(w.frames, w.prior).status, SfmStatus::not_enough_parallax);
		}
}

TEST(StructureFromMotion, StandsOutliers)
{
	for (const Path& path : {kForward, kArc, kSideways})
	{
		const Window w = makeWindow(path, {0.3 * kPixel_rad, 0.2, 77});
		const SfmResult result = StructureFromMotion(SfmOptions()).reconstruct(w.frames, w.prior);
		ASSERT_EQ(result.status, SfmStatus::ok) << toString(result.status);
		const Errors e = errorsOf(result, w);
		std::cout << "[measured] 20 % outliers: rotation " << e.rotation_rad << " rad, position " << e.position_relative << " of the path, "
		          << result.points.size() << " points\n";
		EXPECT_LT(e.rotation_rad, 5e-3);
		EXPECT_LT(e.position_relative, 0.1);
	}
}

TEST(StructureFromMotion, SaysWhyItCannot)
{
	Window w = makeWindow(kArc);
	EXPECT_EQ(StructureFromMotion(SfmOptions()).reconstruct({}).status, SfmStatus::too_few_frames);
	EXPECT_EQ(StructureFromMotion(SfmOptions()).reconstruct({w.frames.begin(), w.frames.begin() + 4}).status, SfmStatus::too_few_frames);
	for (FeatureFrame& frame : w.frames) frame.features.resize(15);
	EXPECT_EQ(StructureFromMotion(SfmOptions()).reconstruct(w.frames).status, SfmStatus::few_correspondences);
	for (FeatureFrame& frame : w.frames) frame.features.clear();
	EXPECT_EQ(StructureFromMotion(SfmOptions()).reconstruct(w.frames).status, SfmStatus::few_correspondences);

	std::mt19937_64 generator(1);
	std::normal_distribution<double> normal(0, 0.3);
	Window nonsense = makeWindow(kArc);
	for (FeatureFrame& frame : nonsense.frames)
		for (FeatureObservation& f : frame.features)
			f.bearing_C = (f.bearing_C + Eigen::Vector3d(normal(generator), normal(generator), 0)).normalized();
	EXPECT_NE(StructureFromMotion(SfmOptions()).reconstruct(nonsense.frames).status, SfmStatus::ok);
}

TEST(StructureFromMotion, RepeatsItselfAndIsQuick)
{
	const Window w = makeWindow(kArc, {0.5 * kPixel_rad, 0.1, 9});
	const StructureFromMotion sfm{SfmOptions()};
	const auto begin = std::chrono::steady_clock::now();
	const SfmResult a = sfm.reconstruct(w.frames, w.prior);
	const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
	const SfmResult b = sfm.reconstruct(w.frames, w.prior);
	std::cout << "[measured] " << ms << " ms for 11 frames, " << a.points.size() << " points\n";
	ASSERT_EQ(a.status, SfmStatus::ok);
	for (size_t k = 0; k < a.T_c0_ck.size(); ++k)
	{
		EXPECT_EQ(a.T_c0_ck[k].p, b.T_c0_ck[k].p);
		EXPECT_EQ(a.T_c0_ck[k].R.coeffs(), b.T_c0_ck[k].R.coeffs());
	}
	EXPECT_EQ(a.interval_covariance, b.interval_covariance);
}
}  // namespace
}  // namespace viwo
