#pragma once

#include <viwo/core/Trajectory.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace viwo
{
/** Covariance of one pose of O relative to the first pose; order x y z roll pitch yaw (m, rad). Entries a planar source leaves open are
 * NaN. */
struct StampedCovariance
{
	int64_t t_ns = 0;
	Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
	std::string flag;
};

/** Reads trajectory_covariance.csv: a header line (t_s, 21 entries of the upper triangle row by row, flag), '#' lines skipped, empty
 * entries NaN.
 *  @throws Error naming file and line: unreadable, no header, wrong number of columns, not a number, stamps not increasing, no entry at
 * all.
 */
std::vector<StampedCovariance> loadCovariances(const std::string& csv_path);

/** Normalised estimation error squared, e^T P^-1 e, averaged over the poses and divided by the degrees of freedom: 1 for an honest
 * covariance, above for an optimistic one (Bar-Shalom, Li, Kirubarajan, "Estimation with applications to tracking and navigation",
 * Sec. 5.4).
 */
struct Nees
{
	double sum = 0;
	size_t degrees_of_freedom = 0;  //!< of the sum
	size_t poses = 0;

	void add(double nees, size_t dof) { sum += nees, degrees_of_freedom += dof, ++poses; }
	/** ANEES per degree of freedom; NaN without a pose. */
	double average() const;
};

/** Errors of a trajectory, measured by its own covariances. */
struct Consistency
{
	Nees position;  //!< x y z, or x y of a planar source
	Nees yaw;
	Nees pose;                      //!< position and yaw together
	size_t invalid = 0;             //!< poses with a covariance that is not positive definite
	size_t without_covariance = 0;  //!< matched poses for which the file has no entry
};

/** Compares the estimate with the reference, both relative to the first matched pose in x, y, z and yaw (roll and pitch are not free:
 * gravity fixes them). The first pose itself, exact by construction, is left out.
 *  @throws Error when fewer than two poses match.
 */
Consistency consistency(const Trajectory& reference, const Trajectory& estimate, const std::vector<StampedCovariance>& covariances,
                        double max_gap_s);
}  // namespace viwo
