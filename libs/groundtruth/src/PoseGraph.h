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

constexpr double kGyroBias_rad_s = 0.01;  //!< standard deviation of what is left of a bias when a log has been read

/** A turn by the gyroscope, from pose a to pose b. */
struct GyroTurn
{
	size_t a = 0, b = 0;
	double turn_rad = 0, dt_s = 0, information = 0;
	size_t bias = 0;  //!< which one it has
};

/** Turns by one gyroscope, whose bias walks: it is constant for a while each. */
struct GyroTurns
{
	static constexpr double kBiasTime_s = 20;  //!< how long a bias stays
	std::vector<GyroTurn> turns;
	std::vector<double> biases_rad_s;  //!< are found by the optimisation
	double walk_rad_s = 0;             //!< standard deviation of the step from one bias to the next
};

/** What edges have in common beyond what each says of itself. */
struct CommonErrors
{
	double odometry_scale = 0;  //!< standard deviation of the scale of all ways by odometry
};

/** Information of a registration as one of many. Errors of ranges depend smoothly on range and incidence, so that a straight wall is seen
 *  bent, by the same amount in scan after scan: two scans that are a way apart agree on a turn that is none, and so do all their
 * neighbours.
 */
Eigen::Matrix3d informationOfMany(const GraphEdge& edge);

/** Whitened residual of an edge, squared. */
double chi2(const GraphEdge& edge, const std::vector<Pose2>& poses);

/** Whether an edge of a registration leaves no direction of the plane open. */
bool holdsAllDirections(const GraphEdge& edge);

/** Least squares over all poses, the first one fixed. @param gyro may be null or empty; where there is any, registrations have their
 *  informationOfMany(): something knows better. @return final cost.
 */
double optimizeGraph(const std::vector<GraphEdge>& edges, std::vector<Pose2>& poses, int iterations, GyroTurns* gyro = nullptr);

/** Covariance (x, y, yaw in the map's axes) of each pose relative to the first, by selected inversion of the sparse normal matrix
 * (Takahashi et al., 1973). Robust kernels weigh as they do at the solution; registrations have their informationOfMany(), what edges have
 * in common is unknown too.
 */
std::vector<Eigen::Matrix3d> graphCovariances(const std::vector<GraphEdge>& edges, const std::vector<Pose2>& poses,
                                              const GyroTurns& gyro = {}, const CommonErrors& common = {});
}  // namespace viwo::gt
