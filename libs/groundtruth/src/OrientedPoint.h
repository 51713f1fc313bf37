#pragma once

#include <viwo/groundtruth/Pose2.h>

#include <Eigen/Core>
#include <Eigen/StdVector>
#include <vector>

namespace viwo::gt
{
/** A point of a surface and its unit normal on the side from which it was seen. The normal is zero where the surface is unknown. */
struct OrientedPoint
{
	Eigen::Vector2d p = Eigen::Vector2d::Zero();
	Eigen::Vector2d n = Eigen::Vector2d::Zero();

	bool hasNormal() const { return n.x() != 0 || n.y() != 0; }
};

using Cloud = std::vector<OrientedPoint>;

inline void appendMoved(const Pose2& T, const Cloud& cloud, Cloud& out)
{
	const Eigen::Matrix2d R = T.R();
	for (const OrientedPoint& point : cloud) out.push_back({R * point.p + T.p, R * point.n});
}
}  // namespace viwo::gt
