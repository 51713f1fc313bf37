#include "ScanSmoother.h"

#include <viwo/core/Error.h>
#include <viwo/core/ParallelFor.h>
#include <viwo/core/Time.h>

#include <Eigen/LU>

#include <algorithm>

namespace viwo::gt
{
namespace
{
constexpr double kKeyDeviation_m = 0.001, kKeyDeviation_rad = 0.0005;
constexpr int kIterations = 4, kLeastInliers = 15;
constexpr double kFarthest_m = 0.5;  // from the guess

Eigen::Matrix3d rotation3(const Pose2& T)
{
	Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
	R.topLeftCorner<2, 2>() = T.R();
	return R;
}

/** Where a scan lies between two keys. */
struct Span
{
	size_t before = 0, after = 0;  //!< keys
};

/** The front-end's pose of a scan carried onto the optimised keys: from both sides, blended by the way. */
Pose2 carried(const FrontEndResult& front_end, const KeyScans& keys, size_t i, const Span& span)
{
	const Pose2& T = front_end.scans[i].T;
	const Pose2 from_before = keys.poses[span.before] * between(front_end.scans[keys.scan[span.before]].T, T);
	if (span.before == span.after) return from_before;
	const Pose2 from_after = keys.poses[span.after] * between(front_end.scans[keys.scan[span.after]].T, T);
	const double a = static_cast<double>(i - keys.scan[span.before]),
	             n = static_cast<double>(keys.scan[span.after] - keys.scan[span.before]);
	const Pose2 d = between(from_before, from_after);
	return from_before * Pose2(d.p * (a / n), d.yaw * (a / n));
}

/** Keys around a place, nearest first, as one thin cloud. */
Cloud mapAround(const KeyScans& keys, const Pose2& T, const GroundTruthOptions& options, const Scales& scales)
{
	std::vector<std::pair<double, size_t>> near;
	for (size_t k = 0; k < keys.size(); ++k)
	{
		const double d = (keys.poses[k].p - T.p).norm();
		if (d < options.graph.neighbour_distance_m) near.emplace_back(d + std::abs(wrapped(keys.poses[k].yaw - T.yaw)), k);
	}
	std::sort(near.begin(), near.end());
	if (near.size() > static_cast<size_t>(options.matching.local_map_keys))
		near.resize(static_cast<size_t>(options.matching.local_map_keys));
	Cloud cloud;
	for (const auto& [cost, k] : near) appendMoved(keys.poses[k], keys.clouds[k], cloud);
	return thinned(cloud, scales.voxel_m);
}

/** Where a scan meets the map around its key; nothing where the two do not fit, or far from the guess. */
std::optional<Registration> placedOnMap(const Cloud& cloud, const PointIndex& map, const Pose2& guess, const Scales& scales,
                                        double min_inlier_ratio)
{
	RegistrationOptions options = scales.registration;
	options.first_radius_m = options.last_radius_m;
	const Registration r = registerCloud(cloud, map, guess, nullptr, options);
	if (r.inlierRatio() < min_inlier_ratio || r.inliers < kLeastInliers || (r.T.p - guess.p).norm() > kFarthest_m) return std::nullopt;
	return r;
}

struct Unary
{
	Pose2 T;
	Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

/** Gauss-Newton over a chain: unary poses and motions between neighbours; block tridiagonal, eliminated forwards. */
class Chain
{
   public:
	Chain(std::vector<Pose2>& poses, const std::vector<Unary>& unary, const std::vector<std::optional<Motion2>>& motion)
	    : poses_(poses), unary_(unary), motion_(motion)
	{
	}

	void iterate()
	{
		const size_t n = poses_.size();
		std::vector<Eigen::Matrix3d> D(n), U(n);  // diagonal blocks, and those that couple i with i + 1
		std::vector<Eigen::Vector3d> b(n);
		for (size_t i = 0; i < n; ++i)
		{
			const Eigen::Vector2d d = poses_[i].p - unary_[i].T.p;
			D[i] = unary_[i].information + 1e-6 * Eigen::Matrix3d::Identity();
			b[i] = -unary_[i].information * Eigen::Vector3d(d.x(), d.y(), wrapped(poses_[i].yaw - unary_[i].T.yaw));
			U[i].setZero();
		}
		for (size_t i = 0; i + 1 < n; ++i)
			if (motion_[i]) addMotion(i, D, U, b);
		for (size_t i = 1; i < n; ++i)
		{
			const Eigen::Matrix3d factor = U[i - 1].transpose() * D[i - 1].inverse();
			D[i] -= factor * U[i - 1];
			b[i] -= factor * b[i - 1];
		}
		Eigen::Vector3d next = Eigen::Vector3d::Zero();
		for (size_t i = n; i-- > 0;)
		{
			next = D[i].inverse() * (b[i] - U[i] * next);
			poses_[i].p += next.head<2>();
			poses_[i].yaw = wrapped(poses_[i].yaw + next.z());
		}
	}

   private:
	void addMotion(size_t i, std::vector<Eigen::Matrix3d>& D, std::vector<Eigen::Matrix3d>& U, std::vector<Eigen::Vector3d>& b) const
	{
		const Pose2 T = between(poses_[i], poses_[i + 1]);
		const double c = std::cos(poses_[i].yaw), s = std::sin(poses_[i].yaw);
		Eigen::Matrix3d A, B;
		A << -c, -s, T.p.y(), s, -c, -T.p.x(), 0, 0, -1;
		B << c, s, 0, -s, c, 0, 0, 0, 1;
		const Eigen::Vector3d e(T.p.x() - motion_[i]->T_ab.p.x(), T.p.y() - motion_[i]->T_ab.p.y(), wrapped(T.yaw - motion_[i]->T_ab.yaw));
		// Wheels that slip are outvoted by the scans on both sides.
		const double weight = 1 / (1 + e.dot(motion_[i]->information * e) / 9);
		const Eigen::Matrix3d W = weight * motion_[i]->information;
		D[i] += A.transpose() * W * A;
		D[i + 1] += B.transpose() * W * B;
		U[i] += A.transpose() * W * B;
		b[i] -= A.transpose() * W * e;
		b[i + 1] -= B.transpose() * W * e;
	}

	std::vector<Pose2>& poses_;
	const std::vector<Unary>& unary_;
	const std::vector<std::optional<Motion2>>& motion_;
};

std::vector<Span> spansOf(size_t scans, const KeyScans& keys)
{
	std::vector<Span> spans(scans);
	size_t next = 0;
	for (size_t i = 0; i < scans; ++i)
	{
		while (next < keys.size() && keys.scan[next] < i) ++next;
		spans[i].after = std::min(next, keys.size() - 1);
		spans[i].before = next < keys.size() && keys.scan[next] == i ? next : next > 0 ? next - 1 : 0;
		if (next == keys.size()) spans[i].before = keys.size() - 1;
	}
	return spans;
}

/** From each scan to the next: by odometry, and where there is none by the front-end, so that nothing falls apart. */
std::vector<std::optional<Motion2>> stepsBetween(const FrontEndResult& front_end, const MotionModel& motion)
{
	const size_t n = front_end.scans.size();
	std::vector<std::optional<Motion2>> steps(n);
	for (size_t i = 0; i + 1 < n; ++i)
	{
		steps[i] = motion.between(i, i + 1);
		if (steps[i]) continue;
		steps[i] = Motion2{between(front_end.scans[i].T, front_end.scans[i + 1].T), Eigen::Vector3d(1e2, 1e2, 1e2).asDiagonal()};
	}
	return steps;
}

/** What the smoothing leaves open of a scan behind its key, bounded by odometry's own uncertainty. */
Eigen::Matrix3d covarianceSince(const KeyScans& keys, size_t k, size_t i, const Unary& unary, const MotionModel& motion)
{
	const Eigen::Matrix3d R = rotation3(keys.poses[k]);
	Eigen::Matrix3d own = unary.information;
	const auto since = motion.between(keys.scan[k], i);
	if (since) own += R * since->information * R.transpose();
	own.diagonal().array() += 1e-6;
	return own.inverse();
}
}  // namespace

std::vector<FinalPose> placeAllScans(const Session& session, const FrontEndResult& front_end, const KeyScans& keys,
                                     const std::vector<Eigen::Matrix3d>& key_covariances, const MotionModel& motion,
                                     const GroundTruthOptions& options, const Scales& scales, const std::function<bool(size_t)>& holdout,
                                     int threads, const std::function<bool(double)>& proceed)
{
	const size_t n = session.scans.size();
	const std::vector<Span> spans = spansOf(n, keys);
	std::vector<FinalPose> result(n);
	std::vector<Pose2> poses(n);
	std::vector<Unary> unary(n);
	// One map serves the scans up to the next key.
	std::vector<std::vector<size_t>> scans_of(keys.size());
	for (size_t i = 0; i < n; ++i) scans_of[spans[i].before].push_back(i);
	if (!proceed(0)) throw Error("interrupted: nothing was written");
	parallelFor(keys.size(), threads,
	            [&](size_t k)
	            {
		            PointIndex index;
		            for (const size_t i : scans_of[k])
		            {
			            result[i].flag = front_end.scans[i].flag;
			            poses[i] = carried(front_end, keys, i, spans[i]);
			            result[i].covariance = key_covariances[k];
			            if (i == keys.scan[k])
			            {
				            unary[i].T = keys.poses[k];
				            unary[i].information.diagonal() << 1 / (kKeyDeviation_m * kKeyDeviation_m),
				                1 / (kKeyDeviation_m * kKeyDeviation_m), 1 / (kKeyDeviation_rad * kKeyDeviation_rad);
				            continue;
			            }
			            if (index.size() == 0) index.build(mapAround(keys, keys.poses[k], options, scales), 2 * scales.voxel_m);
			            const Cloud cloud = scanCloud(session.scans[i], options.scan, motion.twistAt(i), session.range_noise_m);
			            const auto r = placedOnMap(cloud, index, poses[i], scales, options.matching.min_inlier_ratio);
			            if (!r) continue;
			            const double trust = r->trust(options.matching.min_weakest);
			            const PoseFlag flag = flagOf(trust);
			            if (flag == PoseFlag::good) result[i].matched = r->T;
			            if (holdout(i)) continue;
			            unary[i].T = r->T;
			            unary[i].information = r->trustedInformation(trust) / options.graph.inflation;
			            result[i].flag = flag;
		            }
	            });
	const std::vector<std::optional<Motion2>> steps = stepsBetween(front_end, motion);
	Chain chain(poses, unary, steps);
	for (int iteration = 0; iteration < kIterations; ++iteration) chain.iterate();
	for (size_t i = 0; i < n; ++i)
	{
		result[i].T = poses[i];
		const size_t k = spans[i].before;
		if (i != keys.scan[k]) result[i].covariance += covarianceSince(keys, k, i, unary[i], motion);
	}
	return result;
}
}  // namespace viwo::gt
