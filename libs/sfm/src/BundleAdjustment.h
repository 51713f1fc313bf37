#pragma once

#include "Scene.h"

namespace viwo::sfm
{
struct AdjustmentSettings
{
	double sigma_rad = 2e-3;
	int max_iterations = 50;
};

/** Pose of one frame from the points that it sees, starting at `guess` (robust); nothing with fewer than min_points, or when it does not
 * converge onto them. */
std::optional<Pose3> resect(const Scene& scene, int frame, const Pose3& guess, int min_points, const AdjustmentSettings& settings);

/** All poses and points with the reference frame at identity and the scale frame at distance 1 from it. @return whether it converged. */
bool adjust(Scene& scene, const AdjustmentSettings& settings);

/** Triangulates all points anew from all frames, and takes those out that any frame sees farther off than limit_rad: what is wrong by that
 *  much before the adjustment can hold it up.
 */
void removeFalsePoints(Scene& scene, double limit_rad);

/** Takes points out whose inverse distance is known less well than the scene's median inverse distance (times kMaxInverseDistanceSigma):
 * short tracks, and what lies where the camera is heading. The noise can bring such a point close, and a close point claims to know the
 * motion well. The criterion looks at the geometry of the views alone, hence does not choose by the noise.
 */
void removeVaguePoints(Scene& scene, double sigma_rad);

/** Takes observations out that lie farther off than limit_rad or behind their camera, and points that are left with fewer than kMinViews.
 * @return how many. */
int removeOutliers(Scene& scene, double limit_rad);

/** Root mean square of the bearing errors per axis, and how many points that is over. */
double rms_rad(const Scene& scene);

/** See SfmResult::interval_covariance. Schur complement of the points, analytic Jacobians at the solution. Empty when it is not regular. */
Eigen::MatrixXd intervalCovariance(const Scene& scene, double sigma_rad);
}  // namespace viwo::sfm
