#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace viwo
{
/** One tracked corner in one image. The id is never used again once its track has ended. */
struct FeatureObservation
{
	uint64_t id = 0;
	Eigen::Vector2d pixel = Eigen::Vector2d::Zero();       //!< as measured, lens distortion included
	Eigen::Vector3d bearing_C = Eigen::Vector3d::UnitZ();  //!< unit ray in the optical frame
};

/** What the front-end makes of one image; features are sorted by id. Empty for a black or missing image. */
struct FeatureFrame
{
	int64_t t_ns = 0;
	std::vector<FeatureObservation> features;
};
}  // namespace viwo
