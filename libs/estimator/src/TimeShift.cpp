#include "TimeShift.h"

#include "ImuPreintegration.h"
#include "StateOrder.h"
#include "WheelPreintegration.h"

namespace viwo
{
namespace
{
/** Differences between the ends count from so many deviations of the samples' noise on. */
constexpr double kSignificance = 3;

/** Ends that differ by more than the samples scatter: from one to the next a motion moves them little, noise and shaking much. */
bool changes(const ImuPreintegration& interval, const Eigen::Vector3d& change)
{
	const std::vector<ImuSample>& samples = interval.samples();
	double scatter = 0;
	for (size_t i = 1; i < samples.size(); ++i) scatter += (samples[i].gyro_rad_s - samples[i - 1].gyro_rad_s).squaredNorm();
	return change.squaredNorm() * static_cast<double>(samples.size() - 1) > kSignificance * kSignificance * scatter;
}
}  // namespace

ImuTimeShift::Jacobian shiftJacobian(const ImuPreintegration& interval)
{
	ImuTimeShift::Jacobian J = ImuTimeShift::Jacobian::Zero();
	if (interval.samples().empty()) return J;
	const Eigen::Vector3d w0 = interval.samples().front().gyro_rad_s - interval.b_g();
	const Eigen::Vector3d w1 = interval.samples().back().gyro_rad_s - interval.b_g();
	J.segment<3>(StateOrder::phi) = w1 - interval.delta().gamma.conjugate() * w0;
	return J;
}

ImuTimeShift::Jacobian significantShiftJacobian(const ImuPreintegration& interval)
{
	const ImuTimeShift::Jacobian J = shiftJacobian(interval);
	return changes(interval, J.segment<3>(StateOrder::phi)) ? J : ImuTimeShift::Jacobian::Zero();
}

WheelTimeShift::Jacobian shiftJacobian(const WheelPreintegration& interval, const OdometerTwist& begin, const OdometerTwist& end)
{
	WheelTimeShift::Jacobian J;
	J.head<3>() = interval.dR() * end.v_m_s - begin.v_m_s - begin.w_rad_s.cross(interval.dp());
	J.tail<3>() = end.w_rad_s - interval.dR().conjugate() * begin.w_rad_s;
	return J;
}
}  // namespace viwo
