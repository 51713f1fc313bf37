#pragma once

#include "PointIndex.h"

namespace viwo::gt
{
struct RegistrationOptions
{
	double first_radius_m = 0.5;  //!< of correspondences in the first iteration; shrinks to last_radius_m
	double last_radius_m = 0.15;
	double kernel_m = 0.05;  //!< Geman-McClure: residuals beyond it lose their weight
	double sigma_m = 0.02;   //!< of a point's distance to its line
	int iterations = 15;
};

/** What is known of a pose beforehand. */
struct PosePrior
{
	Pose2 T;
	Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  //!< of (x, y, yaw) in the axes of the target
};

/** How a scan lies on a map. */
struct Registration
{
	Pose2 T;  //!< scan in the map
	Eigen::Matrix3d information =
	    Eigen::Matrix3d::Zero();  //!< of (x, y, yaw) in the map's axes, of the scan alone, as if its points were independent
	int points = 0;               //!< with a normal
	int inliers = 0;              //!< of these, within kernel_m of their line
	double rms_m = 0;             //!< of the inliers
	/** Information in the weakest direction of translation as a fraction of what it would be if every inlier faced it. */
	double weakest = 0;
	Eigen::Vector2d weakest_direction = Eigen::Vector2d::Zero();

	/** How far the weakest direction is to be trusted: not at all below min_weakest, where it is clutter and chance, wholly from twice that
	 * on.
	 */
	double trust(double min_weakest) const;
	/** Information of which only this share is left along the weakest direction. */
	Eigen::Matrix3d trustedInformation(double share) const;

	double inlierRatio() const { return points > 0 ? static_cast<double>(inliers) / points : 0; }
};

/** Point-to-line registration (Censi, "An ICP variant using a point-to-line metric", ICRA 2008) by iteratively re-weighted Gauss-Newton.
 *  @param prior may be null.
 */
Registration registerCloud(const Cloud& scan, const PointIndex& map, const Pose2& T_guess, const PosePrior* prior,
                           const RegistrationOptions& options);
}  // namespace viwo::gt
