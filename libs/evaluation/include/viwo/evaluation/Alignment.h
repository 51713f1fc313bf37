#pragma once

#include <viwo/core/Pose3.h>

#include <string>
#include <vector>

namespace viwo
{
/** What is taken out of an estimate before it is compared. */
enum class AlignmentKind
{
	se3,  //!< rotation and translation (6 dof)
	yaw,  //!< rotation about z and translation (4 dof): tilt remains an error
	none,
	sim3  //!< rotation, translation and scale (7 dof), for sources without a metric scale
};

/** "se3", "yaw", "none", "sim3". */
const char* toString(AlignmentKind kind);

/** @throws Error for a word that is none of toString()'s. */
AlignmentKind alignmentFromString(const std::string& word);

/** x_ref = scale * R_ref_est * x_est + p_ref_est. */
struct Similarity
{
	double scale = 1;
	Pose3 T_ref_est;

	/** Position scaled, rotated and shifted; rotation rotated. */
	Pose3 operator*(const Pose3& T_est) const;
};

/** The transform that minimises the sum of squared distances between positions of the same index, in closed form.
 *  se3 and sim3: Umeyama, "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991; yaw: the same
 * restricted to rotations about z. Positions on a line or in one point leave rotations open: those are settled by the orientations, which
 * otherwise weigh nothing to speak of (as points one thousandth of the trajectory's radius away from each position).
 *  @pre both have the same size, at least 1.
 */
Similarity align(AlignmentKind kind, const std::vector<Pose3>& reference, const std::vector<Pose3>& estimate);
}  // namespace viwo
