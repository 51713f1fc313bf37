#include "RandomTrajectory.h"

#include <viwo/core/Error.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <gtest/gtest.h>

#include <iostream>

using namespace viwo;
using namespace viwo::testing;

namespace
{
EvaluationOptions unaligned()
{
	EvaluationOptions options;
	options.alignment = AlignmentKind::none;
	return options;
}

std::string errorOf(const Trajectory& ref, const Trajectory& est)
{
	try
	{
		evaluate(ref, est, {});
	}
	catch (const Error& e)
	{
		return e.what();
	}
	return "";
}

Trajectory straight(double rate_hz, double duration_s, double speed_m_s, double start_s = 0)
{
	Trajectory t;
	for (int i = 0; i <= std::lround(duration_s * rate_hz); ++i)
		t.push_back({1700000000000000000 + nanoseconds(start_s + i / rate_hz),
		             Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(speed_m_s * (start_s + i / rate_hz), 0, 0))});
	return t;
}
}  // namespace

TEST(TrajectoryErrors, HandComputed)
{
	// Errors of (3,0,4), (0,4,0), (0,0,0), (0,0,0) cm.
	const Trajectory ref = straight(10, 0.3, 1);
	const Eigen::Vector3d offsets[] = {{0.03, 0, 0.04}, {0, 0.04, 0}, {0, 0, 0}, {0, 0, 0}};
	Trajectory est;
	for (size_t i = 0; i < 4; ++i)
	{
		StampedPose pose = ref.poses()[i];
		pose.T.p += offsets[i];
		pose.T.R = Eigen::AngleAxisd(i == 3 ? 0.02 : 0.0, Eigen::Vector3d::UnitZ());
		est.push_back(pose);
	}
	const TrajectoryErrors e = evaluate(ref, est, unaligned());
	EXPECT_NEAR(e.ate_xy_m, std::sqrt((0.0009 + 0.0016) / 4), 1e-12);
	EXPECT_NEAR(e.ate_z_m, std::sqrt(0.0016 / 4), 1e-12);
	EXPECT_NEAR(e.ate_xyz_m, std::sqrt((0.0025 + 0.0016) / 4), 1e-12);
	EXPECT_NEAR(e.ate_max_m, 0.05, 1e-12);
	EXPECT_NEAR(e.ate_median_m, 0.02, 1e-12);
	EXPECT_NEAR(e.yaw_rmse_deg, 0.01 * 180 / M_PI, 1e-9);
	EXPECT_NEAR(e.rotation_rmse_deg, 0.01 * 180 / M_PI, 1e-9);
	EXPECT_NEAR(e.length_m, 0.3, 1e-12);
	EXPECT_EQ(e.matched, 4u);
	EXPECT_NEAR(e.coverage, 1, 1e-12);
	EXPECT_TRUE(std::isnan(e.rpe_trans_percent)) << "no two poses are a metre apart";
	EXPECT_TRUE(std::isnan(e.rpe_interval_trans_m));
}

TEST(TrajectoryErrors, ScaleErrorGivesItsPercentage)
{
	const Trajectory ref = straight(10, 60, 0.15);
	const Trajectory est = transformed(ref, [](Pose3 T) { return T.p *= 1.02, T; });
	const TrajectoryErrors e = evaluate(ref, est, unaligned());
	EXPECT_NEAR(e.rpe_trans_percent, 2, 1e-9);
	EXPECT_NEAR(e.rpe_interval_trans_m, 0.003, 1e-9);
	EXPECT_NEAR(e.rpe_rot_deg_per_m, 0, 1e-6);
	EvaluationOptions sim3;
	sim3.alignment = AlignmentKind::sim3;
	EXPECT_NEAR(evaluate(ref, est, sim3).alignment.scale, 1 / 1.02, 1e-12);
	EXPECT_NEAR(evaluate(ref, est, sim3).rpe_trans_percent, 0, 1e-6);
}

TEST(TrajectoryErrors, YawDriftGivesItsRate)
{
	const Trajectory ref = straight(10, 40, 0.5);
	Trajectory est;
	for (const StampedPose& pose : ref.poses())
		est.push_back({pose.t_ns, Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(0.001 * pose.T.p.x(), Eigen::Vector3d::UnitZ())), pose.T.p)});
	const TrajectoryErrors e = evaluate(ref, est, unaligned());
	EXPECT_NEAR(e.rpe_rot_deg_per_m, 0.001 * 180 / M_PI, 1e-6);
	EXPECT_NEAR(e.rpe_interval_rot_deg, 0.0005 * 180 / M_PI, 1e-6);
}

// Interpolation is exact where the motion is straight: stamps between those of the reference must not show.
TEST(TrajectoryErrors, ReferenceIsInterpolated)
{
	const TrajectoryErrors e = evaluate(straight(7, 20, 0.3), straight(10, 19, 0.3, 0.0137), unaligned());
	EXPECT_LT(e.ate_xyz_m, 1e-8);
	EXPECT_EQ(e.matched, 191u);
}

TEST(TrajectoryErrors, CoverageCountsWhatIsMatched)
{
	const Trajectory ref = straight(100, 20, 0.3);
	EXPECT_NEAR(evaluate(ref, straight(10, 5, 0.3, 10), unaligned()).coverage, 0.25, 1e-9);

	Trajectory with_hole;  // 5 s missing in the middle
	const Trajectory whole = straight(10, 20, 0.3);
	for (const StampedPose& pose : whole.poses())
		if (std::abs(pose.T.p.x() / 0.3 - 10) > 2.5 - 1e-9) with_hole.push_back(pose);
	EXPECT_NEAR(evaluate(ref, with_hole, unaligned()).coverage, 0.75, 1e-6);

	const TrajectoryErrors longer = evaluate(ref, straight(10, 40, 0.3), unaligned());
	EXPECT_EQ(longer.matched, 201u);
	EXPECT_EQ(longer.unmatched, 200u);
	EXPECT_NEAR(longer.coverage, 1, 1e-9);

	// A slow estimate is not full of gaps.
	EXPECT_NEAR(evaluate(ref, straight(0.5, 20, 0.3), unaligned()).coverage, 1, 1e-9);
}

TEST(TrajectoryErrors, GapsOfTheReferenceAreNotBridged)
{
	Trajectory ref;
	const Trajectory whole = straight(100, 20, 0.3);
	for (const StampedPose& pose : whole.poses())
		if (std::abs(pose.T.p.x() / 0.3 - 10) > 0.995) ref.push_back(pose);
	EvaluationOptions options = unaligned();
	EXPECT_EQ(evaluate(ref, straight(10, 20, 0.3, 0.005), options).matched, 180u);
	options.max_gap_s = 5;
	EXPECT_EQ(evaluate(ref, straight(10, 20, 0.3, 0.005), options).matched, 200u);
}

TEST(TrajectoryErrors, SaysWhyNothingMatches)
{
	const Trajectory ref = straight(10, 10, 0.3);
	EXPECT_NE(errorOf(ref, straight(10, 10, 0.3, 1000)).find("no overlap in time"), std::string::npos);
	Trajectory single;
	single.push_back(ref.poses()[3]);
	EXPECT_NE(errorOf(ref, single).find("estimate has fewer than two poses"), std::string::npos);
	EXPECT_NE(errorOf(single, ref).find("reference has fewer than two poses"), std::string::npos);
	EXPECT_NE(errorOf(straight(0.5, 10, 0.3), straight(10, 5, 0.3, 0.01)).find("gaps longer than 0.5 s"), std::string::npos);
}

// The same figures by another road: rotation by gradient-free search over rotation vectors, pairs by exhaustive comparison.
TEST(TrajectoryErrors, AgreesWithBruteForce)
{
	std::mt19937_64 random(7);
	const Trajectory ref = windingDrive(10, 30);
	const Pose3 T = randomPose(random, 2, 0.5);
	const Trajectory est = transformed(ref, [&](const Pose3& pose) { return T * pose * randomPose(random, 0.03, 0.01); });
	std::vector<MatchedPose> matches;
	const TrajectoryErrors e = evaluate(ref, est, {}, &matches);

	Eigen::Vector3d mean_ref = Eigen::Vector3d::Zero(), mean_est = Eigen::Vector3d::Zero();
	const double n = static_cast<double>(ref.size());
	for (size_t i = 0; i < ref.size(); ++i) mean_ref += ref.poses()[i].T.p / n, mean_est += est.poses()[i].T.p / n;
	const auto cost = [&](const Eigen::Vector3d& phi)
	{
		const Eigen::AngleAxisd R(phi.norm(), phi.norm() > 0 ? phi.normalized() : Eigen::Vector3d::UnitX());
		double sum = 0;
		for (size_t i = 0; i < ref.size(); ++i)
			sum += (R * (est.poses()[i].T.p - mean_est) - (ref.poses()[i].T.p - mean_ref)).squaredNorm() / n;
		return sum;
	};
	Eigen::Vector3d phi = Eigen::Vector3d::Zero();
	for (double step = 0.5; step > 1e-9;)
	{
		bool better = false;
		for (int axis = 0; axis < 3; ++axis)
			for (const double sign : {-1.0, 1.0})
			{
				Eigen::Vector3d trial = phi;
				trial[axis] += sign * step;
				if (cost(trial) < cost(phi)) phi = trial, better = true;
			}
		if (!better) step /= 2;
	}
	std::cout << "[measured] ATE closed form " << e.ate_xyz_m << " m, by search " << std::sqrt(cost(phi)) << " m\n";
	EXPECT_NEAR(e.ate_xyz_m, std::sqrt(cost(phi)), 1e-9);

	double sum = 0;
	size_t pairs = 0;
	for (size_t i = 0; i < ref.size(); ++i)
		for (size_t j = 0; j < ref.size(); ++j)
			if (ref.poses()[j].t_ns - ref.poses()[i].t_ns == 1000000000)
			{
				const Eigen::Matrix3d Ri = ref.poses()[i].T.R.toRotationMatrix(), Pi = est.poses()[i].T.R.toRotationMatrix();
				const Eigen::Matrix3d Rj = ref.poses()[j].T.R.toRotationMatrix();
				const Eigen::Vector3d d_ref = Ri.transpose() * (ref.poses()[j].T.p - ref.poses()[i].T.p);
				const Eigen::Vector3d d_est = Pi.transpose() * (est.poses()[j].T.p - est.poses()[i].T.p);
				sum += ((Ri.transpose() * Rj).transpose() * (d_est - d_ref)).squaredNorm();
				++pairs;
			}
	ASSERT_EQ(e.rpe_interval_pairs, pairs);
	EXPECT_NEAR(e.rpe_interval_trans_m, std::sqrt(sum / static_cast<double>(pairs)), 1e-9);
}

TEST(TrajectoryErrors, AnglesWrap)
{
	EXPECT_NEAR(wrapAngle(2 * M_PI - 0.1), -0.1, 1e-12);
	EXPECT_NEAR(wrapAngle(-2 * M_PI - 0.1), -0.1, 1e-12);
	EXPECT_GT(wrapAngle(-M_PI), 0);
}
