#include "EpipolarGate.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>

namespace viwo
{
namespace
{
constexpr size_t kMinSupport = 5;
constexpr double kMinSupportShare = 0.4;
constexpr size_t kMinPairsForEssential = 8;
constexpr double kMinForward = 0.17;  // cos of 80 degrees

struct RotatedPair
{
	Eigen::Vector3d a;  // previous
	Eigen::Vector3d b;  // current, in previous axes
	Eigen::Vector3d n;  // a x b
};

bool agrees(const RotatedPair& p, const Eigen::Vector3d& t, double threshold_rad)
{
	const Eigen::Vector3d t_a = t.cross(p.a), t_b = t.cross(p.b);
	const double spread = std::sqrt(t_a.squaredNorm() + t_b.squaredNorm());
	if (std::abs(t.dot(p.n)) > threshold_rad * spread) return false;
	// A point before both cameras moves away from t: n . (t x a) >= 0, up to the noise.
	return p.n.dot(t_a) >= -threshold_rad * t_a.norm();
}

size_t countAgreeing(const std::vector<RotatedPair>& pairs, const Eigen::Vector3d& t, double threshold_rad)
{
	return static_cast<size_t>(
	    std::count_if(pairs.begin(), pairs.end(), [&](const RotatedPair& p) { return agrees(p, t, threshold_rad); }));
}

/** t or -t, whichever more pairs agree with. */
void consider(const std::vector<RotatedPair>& moved, const Eigen::Vector3d& t, double threshold_rad, Eigen::Vector3d& best,
              size_t& best_count)
{
	for (const Eigen::Vector3d& candidate : {t, Eigen::Vector3d(-t)})
	{
		const size_t count = countAgreeing(moved, candidate, threshold_rad);
		if (count <= best_count) continue;
		best_count = count;
		best = candidate;
	}
}

/** Least-squares direction of translation of the pairs that agree with t. */
Eigen::Vector3d polish(const std::vector<RotatedPair>& moved, const Eigen::Vector3d& t, double threshold_rad)
{
	Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
	for (const RotatedPair& p : moved)
	{
		if (!agrees(p, t, threshold_rad)) continue;
		const double weight = 1 / std::max(1e-6, t.cross(p.a).squaredNorm() + t.cross(p.b).squaredNorm());
		N += weight * p.n * p.n.transpose();
	}
	return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(N).eigenvectors().col(0);
}

/** Direction of translation with its support among the pairs that have moved. */
size_t searchTranslation(const std::vector<RotatedPair>& moved, const EpipolarGateSettings& settings, Eigen::Vector3d& best)
{
	size_t best_count = 0;
	if (moved.size() < kMinSupport) return best_count;
	std::mt19937_64 generator(settings.seed);
	for (int i = 0; i < settings.iterations; ++i)
	{
		const RotatedPair& p = moved[generator() % moved.size()];
		const RotatedPair& q = moved[generator() % moved.size()];
		const Eigen::Vector3d t = p.n.cross(q.n);
		const double norm = t.norm();
		if (norm < 1e-3 * p.n.norm() * q.n.norm() || norm == 0) continue;
		consider(moved, t / norm, settings.threshold_rad, best, best_count);
		if (best_count == moved.size()) break;
	}
	if (best_count >= kMinSupport) consider(moved, polish(moved, best, settings.threshold_rad), settings.threshold_rad, best, best_count);
	return best_count;
}
}  // namespace

std::vector<bool> agreeWithRotation(const std::vector<BearingPair>& pairs, const Eigen::Quaterniond& R_previous_current,
                                    const EpipolarGateSettings& settings)
{
	std::vector<RotatedPair> rotated, moved;
	rotated.reserve(pairs.size());
	for (const BearingPair& pair : pairs)
	{
		const Eigen::Vector3d b = R_previous_current * pair.current;
		rotated.push_back({pair.previous, b, pair.previous.cross(b)});
		if ((b - pair.previous).norm() > settings.threshold_rad) moved.push_back(rotated.back());
	}
	Eigen::Vector3d t = Eigen::Vector3d::Zero();
	const size_t support = searchTranslation(moved, settings, t);
	const bool translates = support >= kMinSupport && static_cast<double>(support) >= kMinSupportShare * static_cast<double>(moved.size());

	std::vector<bool> result;
	result.reserve(pairs.size());
	for (const RotatedPair& p : rotated)
	{
		const bool still = (p.b - p.a).norm() <= settings.threshold_rad;
		result.push_back(still || (translates && agrees(p, t, settings.threshold_rad)));
	}
	return result;
}

std::vector<bool> agreeWithEssential(const std::vector<BearingPair>& pairs, const EpipolarGateSettings& settings)
{
	std::vector<bool> result(pairs.size(), true);
	std::vector<cv::Point2d> previous, current;
	std::vector<size_t> index;
	for (size_t i = 0; i < pairs.size(); ++i)
	{
		const Eigen::Vector3d &a = pairs[i].previous, &b = pairs[i].current;
		if (a.z() < kMinForward || b.z() < kMinForward) continue;
		previous.emplace_back(a.x() / a.z(), a.y() / a.z());
		current.emplace_back(b.x() / b.z(), b.y() / b.z());
		index.push_back(i);
	}
	if (index.size() < kMinPairsForEssential) return result;
	std::vector<uint8_t> inlier;
	cv::findEssentialMat(previous, current, cv::Mat::eye(3, 3, CV_64F), cv::RANSAC, 0.999, settings.threshold_rad, inlier);
	if (inlier.size() != index.size()) return result;
	for (size_t k = 0; k < index.size(); ++k) result[index[k]] = inlier[k] != 0;
	return result;
}
}  // namespace viwo
