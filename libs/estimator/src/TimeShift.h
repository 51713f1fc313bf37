#pragma once

#include <Eigen/Core>

namespace viwo
{
class ImuPreintegration;
class WheelPreintegration;

/** What a preintegrated interval becomes where the clock of its sensor is off: both ends of the cut move by the same time, and its length
 *  stays. To first order the deltas change by per_s * (offset - at_s), rotations on the right.
 */
template <int N>
struct TimeShift
{
	using Jacobian = Eigen::Matrix<double, N, 1>;

	Jacobian per_s = Jacobian::Zero();  //!< in the rows of the preintegration's covariance
	double at_s = 0;                    //!< the offset at which the interval was cut
};
using ImuTimeShift = TimeShift<9>;    //!< alpha, phi, beta
using WheelTimeShift = TimeShift<6>;  //!< dp, phi

/** How O moves at one instant, in its own axes. */
struct OdometerTwist
{
	Eigen::Vector3d v_m_s = Eigen::Vector3d::Zero();
	Eigen::Vector3d w_rad_s = Eigen::Vector3d::Zero();
};

/** With rates w0, w1 at begin and end, the bias taken off: dgamma = w1 - gamma^T w0. alpha and beta are left as they are: forces at an end
 * carry the noise of a sample that the interval has integrated, and the products would pull the clock by milliseconds on a drive that says
 * nothing of it. Cutting anew at the offset found brings them along. Of an interval without samples it is zero.
 */
ImuTimeShift::Jacobian shiftJacobian(const ImuPreintegration& interval);

/** shiftJacobian() without what its own noise may have made: zero where the rates at the two ends do not differ by more than samples differ
 *  from their neighbours. Squares of noise would add up to information about a clock that nothing has measured.
 */
ImuTimeShift::Jacobian significantShiftJacobian(const ImuPreintegration& interval);

/** dphi = w1 - dR^T w0,  dp = -w0 x dp - v0 + dR v1, with the twist at begin and end as states and gyro tell it: ticks are coarse, and
 * their noise is that of the interval. */
WheelTimeShift::Jacobian shiftJacobian(const WheelPreintegration& interval, const OdometerTwist& begin, const OdometerTwist& end);
}  // namespace viwo
