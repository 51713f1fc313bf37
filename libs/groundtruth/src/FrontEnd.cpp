#include "FrontEnd.h"

#include <viwo/core/Error.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <deque>

namespace viwo::gt
{
namespace
{
constexpr int kFewestPoints = 15;
constexpr double kGoodTrust = 0.25;
constexpr double kElsewhere_m = 0.3, kElsewhere_rad = 15 * kDegree;
constexpr double kSearchScore = 0.4;
constexpr double kLongestRatio = 10, kLongGap_s = 1;

/** Keys of the recent past around the robot, as one thin cloud. */
class LocalMap
{
   public:
	LocalMap(const Scales& scales, const MatchingOptions& options) : scales_(scales), options_(options) {}

	void add(const Pose2& T, const Cloud& cloud)
	{
		const double way_m = keys_.empty() ? 0 : keys_.back().way_m + (T.p - keys_.back().p).norm();
		keys_.push_back({T.p, way_m, {}});
		appendMoved(T, cloud, keys_.back().cloud);
		while (way_m - keys_.front().way_m > options_.local_map_way_m) keys_.pop_front();

		// The newest keys whatever the distance, then the nearest: a robot that comes back out of a room finds the corridor it left.
		std::vector<std::pair<double, size_t>> order;
		for (size_t k = 0; k < keys_.size(); ++k) order.emplace_back(k + 5 >= keys_.size() ? 0 : (keys_[k].p - T.p).norm(), k);
		std::sort(order.begin(), order.end());
		if (order.size() > static_cast<size_t>(options_.local_map_keys)) order.resize(static_cast<size_t>(options_.local_map_keys));
		points_.clear();
		for (const auto& [distance, k] : order) points_.insert(points_.end(), keys_[k].cloud.begin(), keys_[k].cloud.end());
		points_ = thinned(points_, scales_.voxel_m);
		index_.build(points_, 2 * scales_.voxel_m);
		matcher_.reset();
	}

	bool empty() const { return keys_.empty(); }
	const PointIndex& index() const { return index_; }
	const CorrelativeMatcher& matcher()
	{
		if (!matcher_) matcher_ = std::make_unique<CorrelativeMatcher>(points_, scales_.field_resolution_m, scales_.field_sigma_m);
		return *matcher_;
	}

   private:
	struct Key
	{
		Eigen::Vector2d p;
		double way_m;
		Cloud cloud;
	};
	const Scales& scales_;
	const MatchingOptions& options_;
	std::deque<Key> keys_;
	Cloud points_;
	PointIndex index_;
	std::unique_ptr<CorrelativeMatcher> matcher_;
};

class Tracker
{
   public:
	Tracker(const Session& session, const MotionModel& motion, const GroundTruthOptions& options, const Scales& scales)
	    : session_(session), motion_(motion), options_(options), scales_(scales), map_(scales, options.matching)
	{
	}

	void track(size_t i, bool may_be_key, FrontEndResult& result)
	{
		const Cloud cloud = scanCloud(session_.scans[i], options_.scan, motion_.twistAt(i), session_.range_noise_m);
		int points = 0;
		for (const OrientedPoint& point : cloud) points += point.hasNormal();
		const PosePrior guess = predict(i, result.scans);
		TrackedScan scan;
		scan.T = guess.T;
		if (points >= kFewestPoints && !map_.empty()) match(cloud, guess, i, scan, result);
		if (points >= kFewestPoints && map_.empty())
		{
			scan.flag = PoseFlag::good;
			scan.trust = 1;
		}
		result.scans.push_back(scan);
		if (!may_be_key || points < kFewestPoints || !farEnough(scan.T, result)) return;
		result.keys.push_back(i);
		result.key_clouds.push_back(cloud);
		map_.add(scan.T, cloud);
	}

   private:
	/** From the scan before, as from the one before that; after a long while no motion. */
	Pose2 constantVelocity(size_t i, const std::vector<TrackedScan>& done) const
	{
		if (i < 2) return {};
		const double last_s = secondsBetween(session_.scans[i - 2].t_ns, session_.scans[i - 1].t_ns);
		const double now_s = secondsBetween(session_.scans[i - 1].t_ns, session_.scans[i].t_ns);
		// Stamps that were repaired may follow each other at once: no speed comes from them.
		if (now_s > kLongestRatio * last_s || now_s >= kLongGap_s) return {};
		const Pose2 last = between(done[i - 2].T, done[i - 1].T);
		return {last.p * (now_s / last_s), last.yaw * (now_s / last_s)};
	}

	PosePrior predict(size_t i, const std::vector<TrackedScan>& done) const
	{
		PosePrior prior;
		if (i == 0) return prior;
		const Pose2& T_last = done.back().T;
		const auto motion = motion_.between(i - 1, i);
		Motion2 step;
		if (motion)
			step = *motion;
		else if (i > 1)
		{
			step.T_ab = constantVelocity(i, done);
			step.information.diagonal() << 1 / 0.01, 1 / 0.01, 1 / 0.01;
		}
		prior.T = T_last * step.T_ab;
		Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
		R.topLeftCorner<2, 2>() = T_last.R();
		prior.information = R * step.information * R.transpose();
		return prior;
	}

	bool trusted(const Registration& r) const
	{
		return r.inlierRatio() >= options_.matching.min_inlier_ratio && r.inliers >= kFewestPoints;
	}

	/** Leaves r where nothing better is found in the window around T. */
	void search(const Cloud& cloud, const Pose2& T, Registration& r)
	{
		const auto found = map_.matcher().search(cloud, T, options_.matching.search_distance_m,
		                                         options_.matching.search_angle_deg * kDegree, kSearchScore);
		if (!found) return;
		const Registration second = registerCloud(cloud, map_.index(), found->T, nullptr, scales_.registration);
		if (second.inliers > r.inliers) r = second;
	}

	/** Where a scan lies nowhere near the place that odometry leads to, odometry may be wrong by any length: as if there were none. Not
	 * after a while without scans, over which nothing else leads. */
	void searchWithoutOdometry(const Cloud& cloud, PosePrior& guess, size_t i, FrontEndResult& result, Registration& r)
	{
		if (secondsBetween(session_.scans[i - 1].t_ns, session_.scans[i].t_ns) >= kLongGap_s) return;
		const Pose2 T = result.scans.back().T * constantVelocity(i, result.scans);
		const auto elsewhere = [&](const Pose2& d) { return d.p.norm() > kElsewhere_m || std::abs(d.yaw) > kElsewhere_rad; };
		if (!motion_.between(i - 1, i) || !elsewhere(between(T, guess.T))) return;
		Registration other = registerCloud(cloud, map_.index(), T, nullptr, scales_.registration);
		if (!trusted(other)) search(cloud, T, other);
		if (!trusted(other) || !elsewhere(between(other.T, guess.T))) return;
		r = other;
		guess.T = T;
		result.contradicted.push_back(i);
	}

	void match(const Cloud& cloud, PosePrior guess, size_t i, TrackedScan& scan, FrontEndResult& result)
	{
		Registration r = registerCloud(cloud, map_.index(), guess.T, &guess, scales_.registration);
		if (!trusted(r))
		{
			++result.searches;
			search(cloud, guess.T, r);
		}
		if (!trusted(r)) searchWithoutOdometry(cloud, guess, i, result, r);
		scan.inlier_ratio = r.inlierRatio();
		if (!trusted(r)) return;
		scan.T = r.T;
		scan.trust = r.trust(options_.matching.min_weakest);
		scan.information = r.trustedInformation(scan.trust);
		scan.flag = flagOf(scan.trust);
		// Along a corridor the map of the last scans would hold the robot back a little at every scan: odometry alone moves it there.
		scan.T.p += (1 - scan.trust) * r.weakest_direction * r.weakest_direction.dot(guess.T.p - r.T.p);
	}

	bool farEnough(const Pose2& T, const FrontEndResult& result) const
	{
		if (result.keys.empty()) return true;
		const Pose2 step = between(result.scans[result.keys.back()].T, T);
		return step.p.norm() > options_.matching.key_distance_m || std::abs(step.yaw) > options_.matching.key_angle_deg * kDegree;
	}

	const Session& session_;
	const MotionModel& motion_;
	const GroundTruthOptions& options_;
	const Scales& scales_;
	LocalMap map_;
};
}  // namespace

const char* nameOf(PoseFlag flag)
{
	switch (flag)
	{
		case PoseFlag::good:
			return "good";
		case PoseFlag::degenerate:
			return "degenerate";
		case PoseFlag::odometry_only:
			break;
	}
	return "odometry_only";
}

PoseFlag flagOf(double trust)
{
	return trust < kGoodTrust ? PoseFlag::degenerate : PoseFlag::good;
}

Scales::Scales(double noise_m)
{
	// Usual lasers (1 to 2 cm) share one set of lengths; noisier ones need wider ones.
	const double factor = std::max(1.0, noise_m / 0.02);
	voxel_m = 0.08 * std::min(factor, 4.0);
	registration.sigma_m = 0.02 * factor;
	registration.kernel_m = 0.06 * factor;
	registration.last_radius_m = 0.2 * std::min(factor, 5.0);
	registration.first_radius_m = 2.5 * registration.last_radius_m;
	field_sigma_m = 0.06 * factor;
	field_resolution_m = 0.05 * std::min(factor, 3.0);
	// What a single pair tells less well, more pairs make up for.
	partners = std::min(2.0, std::sqrt(factor));
}

FrontEndResult trackScans(const Session& session, const MotionModel& motion, const GroundTruthOptions& options, const Scales& scales,
                          const std::function<bool(size_t)>& may_be_key, const std::function<bool(double)>& proceed)
{
	FrontEndResult result;
	Tracker tracker(session, motion, options, scales);
	for (size_t i = 0; i < session.scans.size(); ++i)
	{
		tracker.track(i, may_be_key(i), result);
		if (i % 64 == 0 && !proceed(static_cast<double>(i) / static_cast<double>(session.scans.size())))
			throw Error("interrupted: nothing was written");
	}
	return result;
}
}  // namespace viwo::gt
