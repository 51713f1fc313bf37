#pragma once

#include "OrientedPoint.h"
#include "Session.h"

namespace viwo::gt
{
/** Motion of O during a sweep. */
struct Twist2
{
	Eigen::Vector2d v = Eigen::Vector2d::Zero();  //!< m/s, in O's axes
	double w_rad_s = 0;
};

/** The points of a scan in O at the scan's stamp, motion during the sweep undone, with normals fitted to neighbouring beams.
 *  @param noise_m of a range: wider neighbourhoods where it is large.
 */
Cloud scanCloud(const Scan& scan, const ScanOptions& options, const Twist2& twist, double noise_m);
}  // namespace viwo::gt
