#pragma once

#include "OrientedPoint.h"

namespace viwo::gt
{
/** Nearest neighbours among oriented points, by a grid of buckets. Rebuilding keeps the memory. */
class PointIndex
{
   public:
	/** @param cell_m side of a bucket; of the order of the search radius. Points without a normal are left out. */
	void build(const Cloud& points, double cell_m);

	/** The point nearest to p within radius_m whose normal is within 60 deg of n (any normal where n is zero); null if none. */
	const OrientedPoint* nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& n, double radius_m) const;

	size_t size() const { return points_.size(); }

   private:
	int column(double x) const { return static_cast<int>(std::floor((x - min_.x()) * inverse_cell_)); }
	int row(double y) const { return static_cast<int>(std::floor((y - min_.y()) * inverse_cell_)); }

	Eigen::Vector2d min_ = Eigen::Vector2d::Zero();
	double inverse_cell_ = 1;
	int columns_ = 0, rows_ = 0;
	std::vector<int> begin_;      //!< of each bucket in points_; one more at the end
	std::vector<int> bucket_of_;  //!< scratch
	Cloud points_;
};

/** One mean point for each square of `voxel_m` and direction of normals: walls seen by many scans become thin. Order does not depend on
 * time. */
Cloud thinned(const Cloud& points, double voxel_m);
}  // namespace viwo::gt
