#pragma once

#include <viwo/core/FeatureFrame.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace viwo::sfm
{
struct Observation
{
	int frame = 0;
	Eigen::Vector3d bearing;
};

/** One feature through the window; observations by frame. */
struct Track
{
	uint64_t id = 0;
	std::vector<Observation> observations;

	/** nullptr where the frame does not see it. */
	const Eigen::Vector3d* bearingIn(int frame) const;
};

/** From two views alone a nearby point and a false one look alike, and neighbouring frames leave its distance open. */
constexpr size_t kMinViews = 3;

/** By id; features with fewer views are left out. */
std::vector<Track> collectTracks(const std::vector<FeatureFrame>& frames);

struct Correspondence
{
	Eigen::Vector3d a, b;  //!< bearings in two frames
};
std::vector<Correspondence> correspondences(const std::vector<Track>& tracks, int frame_a, int frame_b);

/** Rotation R_ab that brings the bearings b onto a best (Wahba's problem, outliers trimmed). */
Eigen::Quaterniond bestRotation(const std::vector<Correspondence>& pairs);

/** The 70th percentile of the angles that are left between the bearings after the best rotation: what only a translation explains. */
double rotationFreeParallax_rad(const std::vector<Correspondence>& pairs);
}  // namespace viwo::sfm
