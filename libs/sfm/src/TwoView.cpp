#include "TwoView.h"

#include <viwo/sfm/ScopedQuietLog.h>

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <viwo/core/So3.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

namespace viwo::sfm
{
namespace
{
constexpr double kMinAgreeingShare = 0.6;
constexpr double kMinForward = 0.17;  // cos of 80 degrees from the optical axis: further out the normalised plane serves badly
constexpr int kMinForFivePoints = 8;
constexpr int kTranslationRounds = 5;

/** Sampson distance (rad) of a pair from the epipolar geometry of T_ab. */
template <typename T>
T sampson(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b_in_a, const Eigen::Matrix<T, 3, 1>& t)
{
	const T spread = t.cross(a).squaredNorm() + t.cross(b_in_a).squaredNorm();
	return t.dot(a.cross(b_in_a)) / sqrt(spread + T(1e-12));
}

struct EpipolarCost
{
	template <typename T>
	bool operator()(const T* rotation_ab, const T* p_ab, T* residual) const
	{
		const Eigen::Matrix<T, 3, 1> b = pair.b.template cast<T>();
		Eigen::Matrix<T, 3, 1> b_in_a;
		ceres::AngleAxisRotatePoint(rotation_ab, b.data(), b_in_a.data());
		const Eigen::Matrix<T, 3, 1> t(p_ab[0], p_ab[1], p_ab[2]);
		residual[0] = sampson<T>(pair.a.template cast<T>(), b_in_a, t) / T(sigma_rad);
		return true;
	}
	Correspondence pair;
	double sigma_rad;
};

/** Both depths along the bearings are positive, up to the noise of a distant point. */
bool beforeBoth(const Correspondence& c, const Pose3& T_ab, double tolerance_rad)
{
	const Eigen::Vector3d b = T_ab.R * c.b, n = c.a.cross(b), t_a = T_ab.p.cross(c.a), t_b = T_ab.p.cross(b);
	return n.dot(t_a) >= -tolerance_rad * t_a.norm() && n.dot(t_b) >= -tolerance_rad * t_b.norm();
}

struct Scored
{
	Pose3 T_ab;
	size_t agreeing = 0;
	double cost = 0;
};

Scored scored(const Pose3& T_ab, const std::vector<Correspondence>& pairs, double sigma_rad, double outlier_sigmas)
{
	Scored s{T_ab, 0, 0};
	for (const Correspondence& c : pairs)
	{
		const double e = std::abs(sampson<double>(c.a, T_ab.R * c.b, T_ab.p)) / sigma_rad;
		const bool agrees = e < outlier_sigmas && beforeBoth(c, T_ab, outlier_sigmas * sigma_rad);
		s.agreeing += agrees;
		s.cost += agrees ? e * e : outlier_sigmas * outlier_sigmas;
	}
	return s;
}

Pose3 refined(const Pose3& T_ab, const std::vector<Correspondence>& pairs, double sigma_rad)
{
	const Eigen::Vector3d phi = so3::log(T_ab.R), direction = T_ab.p.normalized();
	double rotation[3] = {phi.x(), phi.y(), phi.z()}, p[3] = {direction.x(), direction.y(), direction.z()};
	ceres::Problem problem;
	for (const Correspondence& c : pairs)
		problem.AddResidualBlock(new ceres::AutoDiffCostFunction<EpipolarCost, 1, 3, 3>(new EpipolarCost{c, sigma_rad}),
		                         new ceres::CauchyLoss(2), rotation, p);
	problem.SetManifold(p, new ceres::SphereManifold<3>());
	ceres::Solver::Options options;
	options.linear_solver_type = ceres::DENSE_QR;
	options.max_num_iterations = 30;
	options.num_threads = 1;
	options.logging_type = ceres::SILENT;
	ceres::Solver::Summary summary;
	const ScopedQuietLog quiet;
	ceres::Solve(options, &problem, &summary);
	return {so3::expQuaternion(Eigen::Map<Eigen::Vector3d>(rotation)), Eigen::Map<Eigen::Vector3d>(p).normalized()};
}

std::vector<Pose3> byEssentialMatrix(const std::vector<Correspondence>& pairs, double sigma_rad)
{
	std::vector<cv::Point2d> a, b;
	for (const Correspondence& c : pairs)
	{
		if (c.a.z() < kMinForward || c.b.z() < kMinForward) continue;
		a.emplace_back(c.a.x() / c.a.z(), c.a.y() / c.a.z());
		b.emplace_back(c.b.x() / c.b.z(), c.b.y() / c.b.z());
	}
	if (static_cast<int>(a.size()) < kMinForFivePoints) return {};
	const cv::Mat E = cv::findEssentialMat(b, a, cv::Mat::eye(3, 3, CV_64F), cv::RANSAC, 0.999, 3 * sigma_rad);
	std::vector<Pose3> candidates;
	for (int row = 0; row + 3 <= E.rows; row += 3)
	{
		cv::Mat R1, R2, t;
		cv::decomposeEssentialMat(E.rowRange(row, row + 3), R1, R2, t);
		const Eigen::Vector3d p(t.at<double>(0), t.at<double>(1), t.at<double>(2));
		for (const cv::Mat& R : {R1, R2})
		{
			const Eigen::Matrix3d R_ab = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.ptr<double>());
			candidates.emplace_back(R_ab, p);
			candidates.emplace_back(R_ab, -p);
		}
	}
	return candidates;
}

/** The translation that fits a given rotation: least eigenvector of the epipolar normals, reweighted towards Sampson distances. */
std::vector<Pose3> byRotation(const std::vector<Correspondence>& pairs, const Eigen::Quaterniond& R_ab, double sigma_rad)
{
	Eigen::Vector3d t = Eigen::Vector3d::Zero();
	for (int round = 0; round < kTranslationRounds; ++round)
	{
		Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
		for (const Correspondence& c : pairs)
		{
			const Eigen::Vector3d b = R_ab * c.b, n = c.a.cross(b);
			double weight = 1;
			if (round > 0)
			{
				const double e = sampson<double>(c.a, b, t) / (3 * sigma_rad);
				weight = 1 / ((t.cross(c.a).squaredNorm() + t.cross(b).squaredNorm() + 1e-6) * (1 + e * e));
			}
			N += weight * n * n.transpose();
		}
		t = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(N).eigenvectors().col(0);
	}
	return {Pose3(R_ab, t), Pose3(R_ab, -t)};
}
}  // namespace

std::optional<Pose3> relativePose(const std::vector<Correspondence>& pairs, const std::optional<Eigen::Quaterniond>& R_ab_prior,
                                  double sigma_rad, double outlier_sigmas)
{
	const auto better = [](const Scored& x, const Scored& y) { return x.cost < y.cost; };
	std::vector<Scored> finalists;
	for (const bool use_prior : {false, true})
	{
		if (use_prior && !R_ab_prior) continue;
		const std::vector<Pose3> candidates = use_prior ? byRotation(pairs, *R_ab_prior, sigma_rad) : byEssentialMatrix(pairs, sigma_rad);
		std::vector<Scored> group;
		for (const Pose3& T_ab : candidates) group.push_back(scored(T_ab, pairs, sigma_rad, outlier_sigmas));
		if (group.empty()) continue;
		const Pose3 best = std::min_element(group.begin(), group.end(), better)->T_ab;
		finalists.push_back(scored(refined(best, pairs, sigma_rad), pairs, sigma_rad, outlier_sigmas));
	}
	if (finalists.empty()) return std::nullopt;
	const Scored& winner = *std::min_element(finalists.begin(), finalists.end(), better);
	if (static_cast<double>(winner.agreeing) < kMinAgreeingShare * static_cast<double>(pairs.size())) return std::nullopt;
	return winner.T_ab;
}
}  // namespace viwo::sfm
