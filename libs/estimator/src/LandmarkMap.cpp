#include "LandmarkMap.h"

#include "residuals/BlockAlgebra.h"
#include "residuals/ReprojectionResidual.h"
#include "residuals/StatePrior.h"

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
Pose3 cameraPose(const Frame& frame, const Pose3& T_BC)
{
	return poseFromBlock(frame.pose.data()) * T_BC;
}

/** Error of a sighting on the tangent plane of its bearing, and its derivative by the inverse depth. */
struct DepthLinearization
{
	Eigen::Vector2d error = Eigen::Vector2d::Zero();
	Eigen::Vector2d slope = Eigen::Vector2d::Zero();
	bool in_front = false;
};

DepthLinearization linearize(const Sighting& anchor, const Sighting& other, const Pose3& T_CjCi, double inverse_depth)
{
	DepthLinearization result;
	const Eigen::Vector3d f = T_CjCi.R * anchor.bearing_C + inverse_depth * T_CjCi.p;
	const double norm = f.norm();
	result.in_front = norm > 0 && other.bearing_C.dot(f) > 0;
	if (!result.in_front) return result;
	const Eigen::Vector3d u = f / norm;
	const Eigen::Matrix<double, 3, 2> A = ReprojectionResidual::tangentBasis(other.bearing_C);
	result.error = A.transpose() * u;
	result.slope = A.transpose() * (T_CjCi.p - u * u.dot(T_CjCi.p)) / norm;
	return result;
}

constexpr double kMinInverseDepth_1_m = 1e-3;
}  // namespace

void LandmarkMap::add(Frame& frame)
{
	for (const FeatureObservation& feature : frame.features.features)
	{
		Landmark& landmark = landmarks_[feature.id];
		landmark.id = feature.id;
		landmark.sightings.push_back({&frame, feature.bearing_C, nullptr});
	}
}

void LandmarkMap::forget(const Frame& frame, const Pose3& T_BC)
{
	for (auto it = landmarks_.begin(); it != landmarks_.end();)
	{
		Landmark& landmark = it->second;
		auto& sightings = landmark.sightings;
		const bool was_anchor = sightings.front().frame == &frame;
		const Eigen::Vector3d bearing = sightings.front().bearing_C;
		sightings.erase(std::remove_if(sightings.begin(), sightings.end(), [&](const Sighting& s) { return s.frame == &frame; }),
		                sightings.end());
		if (sightings.empty())
		{
			it = landmarks_.erase(it);
			continue;
		}
		if (was_anchor)
		{
			for (Sighting& s : sightings) s.factor.reset();
			if (landmark.in_use)
			{
				const Pose3 T_new_old = cameraPose(landmark.anchor(), T_BC).inverse() * cameraPose(frame, T_BC);
				const double distance = (T_new_old * Eigen::Vector3d(bearing / landmark.inverse_depth_1_m)).norm();
				landmark.inverse_depth_1_m = std::max(kMinInverseDepth_1_m, 1 / distance);
			}
		}
		if (sightings.size() < 2) landmark.in_use = false;
		++it;
	}
}

void LandmarkMap::eraseAnchoredIn(const Frame& frame)
{
	for (auto it = landmarks_.begin(); it != landmarks_.end();) it = &it->second.anchor() == &frame ? landmarks_.erase(it) : std::next(it);
}

void LandmarkMap::triangulate(const Pose3& T_BC)
{
	for (auto& [id, landmark] : landmarks_)
	{
		if (landmark.in_use || landmark.sightings.size() < 2) continue;
		landmark.prior_factor.reset();
		landmark.in_use = estimateDepth(landmark, T_BC);
	}
}

bool LandmarkMap::estimateDepth(Landmark& landmark, const Pose3& T_BC) const
{
	// Gauss-Newton on the inverse depth alone; the prior makes it solvable without parallax. From two starts, as the error is not convex.
	const Pose3 T_anchor = cameraPose(landmark.anchor(), T_BC);
	const double prior_information = 1 / (settings_.prior_sigma_1_m * settings_.prior_sigma_1_m);
	const double weight = 1 / (settings_.sigma_rad * settings_.sigma_rad);
	double best_cost = 1e300;
	for (const double start : {settings_.prior_mean_1_m, 4 * settings_.prior_mean_1_m})
	{
		double inverse_depth = start, cost = 0;
		for (int iteration = 0; iteration < 8; ++iteration)
		{
			double information = prior_information, gradient = prior_information * (inverse_depth - settings_.prior_mean_1_m);
			cost = prior_information * std::pow(inverse_depth - settings_.prior_mean_1_m, 2);
			for (size_t i = 1; i < landmark.sightings.size(); ++i)
			{
				const Pose3 T_CjCi = cameraPose(*landmark.sightings[i].frame, T_BC).inverse() * T_anchor;
				const DepthLinearization l = linearize(landmark.sightings.front(), landmark.sightings[i], T_CjCi, inverse_depth);
				if (!l.in_front) return false;
				information += weight * l.slope.squaredNorm();
				gradient += weight * l.slope.dot(l.error);
				cost += weight * l.error.squaredNorm();
			}
			inverse_depth = std::max(kMinInverseDepth_1_m, inverse_depth - gradient / information);
		}
		if (cost < best_cost)
		{
			best_cost = cost;
			landmark.inverse_depth_1_m = inverse_depth;
		}
	}
	const double mean_square_rad2 = best_cost / weight / static_cast<double>(landmark.sightings.size() - 1);
	return mean_square_rad2 < settings_.outlier_rad * settings_.outlier_rad;
}

int LandmarkMap::assess(const Pose3& T_BC)
{
	int thrown_out = 0;
	const double weight = 1 / (settings_.sigma_rad * settings_.sigma_rad);
	for (auto it = landmarks_.begin(); it != landmarks_.end();)
	{
		Landmark& landmark = it->second;
		++it;
		landmark.deviation = 1e9;
		if (!landmark.in_use) continue;
		const Pose3 T_anchor = cameraPose(landmark.anchor(), T_BC);
		double information = 1 / (settings_.prior_sigma_1_m * settings_.prior_sigma_1_m), sum_square = 0;
		bool in_front = landmark.inverse_depth_1_m > 0;
		for (size_t i = 1; i < landmark.sightings.size() && in_front; ++i)
		{
			const Pose3 T_CjCi = cameraPose(*landmark.sightings[i].frame, T_BC).inverse() * T_anchor;
			const DepthLinearization l = linearize(landmark.sightings.front(), landmark.sightings[i], T_CjCi, landmark.inverse_depth_1_m);
			in_front = l.in_front;
			information += weight * l.slope.squaredNorm();
			sum_square += l.error.squaredNorm();
		}
		const double mean_square = sum_square / static_cast<double>(landmark.sightings.size() - 1);
		if (!in_front || mean_square > settings_.outlier_rad * settings_.outlier_rad)
		{
			landmarks_.erase(landmark.id);
			++thrown_out;
			continue;
		}
		landmark.deviation = 1 / std::sqrt(information) / landmark.inverse_depth_1_m;
	}
	return thrown_out;
}

int LandmarkMap::countKnown(const Frame& frame) const
{
	int count = 0;
	for (const auto& [id, landmark] : landmarks_)
		if (landmark.in_use && landmark.deviation < settings_.known_deviation && landmark.sightings.back().frame == &frame) ++count;
	return count;
}

int LandmarkMap::countSeen(const Frame& frame) const
{
	int count = 0;
	for (const auto& [id, landmark] : landmarks_)
		if (landmark.in_use && landmark.sightings.back().frame == &frame) ++count;
	return count;
}
}  // namespace viwo
