#pragma once

#include <viwo/groundtruth/Pose2.h>

#include <vector>

namespace viwo::gt
{
/** b seen from a. */
struct GraphEdge
{
	enum class Kind
	{
		odometry,
		scan,  //!< registration of neighbours in time
		loop   //!< registration across time
	};
	size_t a = 0, b = 0;
	Pose2 T_ab;
	Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  //!< of (x, y, yaw) in a's axes
	Kind kind = Kind::scan;
	double kernel = 0;  //!< Cauchy's, in standard deviations; 0: none
};

/** Whitened residual of an edge, squared. */
double chi2(const GraphEdge& edge, const std::vector<Pose2>& poses);

/** Whether an edge of a registration leaves no direction of the plane open. */
bool holdsAllDirections(const GraphEdge& edge);

/** Least squares over all poses, the first one fixed. @return final cost. */
double optimizeGraph(const std::vector<GraphEdge>& edges, std::vector<Pose2>& poses, int iterations);

/** Covariance (x, y, yaw in the map's axes) of each pose relative to the first, by selected inversion of the sparse normal matrix
 * (Takahashi et al., 1973). Robust kernels weigh as they do at the solution.
 */
std::vector<Eigen::Matrix3d> graphCovariances(const std::vector<GraphEdge>& edges, const std::vector<Pose2>& poses);
}  // namespace viwo::gt
