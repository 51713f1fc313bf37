#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace viwo
{
struct BearingPair
{
	Eigen::Vector3d previous;  //!< unit, axes of the previous camera frame
	Eigen::Vector3d current;   //!< unit, axes of the current camera frame
};

struct EpipolarGateSettings
{
	double threshold_rad = 5e-3;
	int iterations = 100;
	uint64_t seed = 1;
};

/** Which pairs agree with a rigid scene seen under a known rotation (x_previous = R x_current) and some translation.
 *
 *  Two pairs determine the direction of translation, t = n_i x n_j with n = b_previous x (R b_current). A pair agrees when its Sampson
 * distance to the epipolar plane is below the threshold and the point does not lie behind the cameras. What has not moved against the
 * rotation agrees with every t, so standing and turning on the spot are no special case, except that a few false matches could then vote
 * for a t of their own: the translation counts only when most of what has moved agrees with it; otherwise whatever has moved is false.
 */
std::vector<bool> agreeWithRotation(const std::vector<BearingPair>& pairs, const Eigen::Quaterniond& R_previous_current,
                                    const EpipolarGateSettings& settings);

/** The same without a rotation: essential matrix by the five-point method and RANSAC. Pairs at more than 80 degrees from the optical axis
 * are not judged. */
std::vector<bool> agreeWithEssential(const std::vector<BearingPair>& pairs, const EpipolarGateSettings& settings);
}  // namespace viwo
