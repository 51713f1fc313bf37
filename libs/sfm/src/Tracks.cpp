#include "Tracks.h"

#include <viwo/core/Ranking.h>

#include <Eigen/SVD>
#include <algorithm>
#include <map>

namespace viwo::sfm
{
namespace
{
constexpr int kTrimmingRounds = 3;
// Driving along a corridor, half of what a camera sees ahead hardly moves and the rest tells enough.
constexpr double kParallaxQuantile = 0.7;

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
	return std::atan2(a.cross(b).norm(), a.dot(b));
}

double angleQuantile(const std::vector<Correspondence>& pairs, const Eigen::Quaterniond& R_ab, double share)
{
	std::vector<double> angles;
	angles.reserve(pairs.size());
	for (const Correspondence& c : pairs) angles.push_back(angleBetween(c.a, R_ab * c.b));
	return valueAtRank(angles, static_cast<size_t>(share * static_cast<double>(angles.size() - 1)));
}

Eigen::Quaterniond wahba(const Eigen::Matrix3d& sum_a_bT)
{
	const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum_a_bT, Eigen::ComputeFullU | Eigen::ComputeFullV);
	Eigen::Vector3d sign(1, 1, svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1);
	return Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose())).normalized();
}
}  // namespace

const Eigen::Vector3d* Track::bearingIn(int frame) const
{
	for (const Observation& o : observations)
		if (o.frame == frame) return &o.bearing;
	return nullptr;
}

std::vector<Track> collectTracks(const std::vector<FeatureFrame>& frames)
{
	std::map<uint64_t, Track> by_id;
	for (size_t k = 0; k < frames.size(); ++k)
		for (const FeatureObservation& f : frames[k].features)
		{
			Track& track = by_id[f.id];
			track.id = f.id;
			track.observations.push_back({static_cast<int>(k), f.bearing_C.normalized()});
		}
	std::vector<Track> tracks;
	for (auto& [id, track] : by_id)
		if (track.observations.size() >= kMinViews) tracks.push_back(std::move(track));
	return tracks;
}

std::vector<Correspondence> correspondences(const std::vector<Track>& tracks, int frame_a, int frame_b)
{
	std::vector<Correspondence> pairs;
	for (const Track& track : tracks)
	{
		const Eigen::Vector3d* a = track.bearingIn(frame_a);
		const Eigen::Vector3d* b = track.bearingIn(frame_b);
		if (a && b) pairs.push_back({*a, *b});
	}
	return pairs;
}

Eigen::Quaterniond bestRotation(const std::vector<Correspondence>& pairs)
{
	Eigen::Quaterniond R_ab = Eigen::Quaterniond::Identity();
	double limit_rad = M_PI;
	for (int round = 0; round < kTrimmingRounds && !pairs.empty(); ++round)
	{
		Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
		for (const Correspondence& c : pairs)
			if (angleBetween(c.a, R_ab * c.b) <= limit_rad) sum += c.a * c.b.transpose();
		R_ab = wahba(sum);
		limit_rad = 2.5 * angleQuantile(pairs, R_ab, 0.5) + 1e-9;
	}
	return R_ab;
}

double rotationFreeParallax_rad(const std::vector<Correspondence>& pairs)
{
	return pairs.empty() ? 0 : angleQuantile(pairs, bestRotation(pairs), kParallaxQuantile);
}
}  // namespace viwo::sfm
