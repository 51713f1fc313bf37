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

/** A signal whose ends differ by more than its samples scatter: from one to the next a motion moves it little, noise and shaking much. */
bool changes(const ImuPreintegration& interval, const Eigen::Vector3d& change, Eigen::Vector3d ImuSample::*signal)
{
	const std::vector<ImuSample>& samples = interval.samples();
	double scatter = 0;
	for (size_t i = 1; i < samples.size(); ++i) scatter += (samples[i].*signal - samples[i - 1].*signal).squaredNorm();
	return change.squaredNorm() * static_cast<double>(samples.size() - 1) > kSignificance * kSignificance * scatter;
}

OdometerTwist twistAt(const WheelSegment& s, const WheelIntrinsics& k)
{
	const WheelTwist twist = twistOf({0, s.v_left_m_s, s.v_right_m_s}, k);
	return {{twist.v_m_s, 0, 0}, {0, 0, twist.w_rad_s}};
}
}  // namespace

ImuTimeShift::Jacobian shiftJacobian(const ImuPreintegration& interval)
{
	if (interval.samples().empty()) return ImuTimeShift::Jacobian::Zero();
	const ImuDelta& d = interval.delta();
	const ImuSample &begin = interval.samples().front(), &end = interval.samples().back();
	const Eigen::Vector3d w0 = begin.gyro_rad_s - interval.b_g(), w1 = end.gyro_rad_s - interval.b_g();
	const Eigen::Vector3d f0 = begin.acc_m_s2 - interval.b_a(), f1 = end.acc_m_s2 - interval.b_a();
	ImuTimeShift::Jacobian J;
	J.segment<3>(StateOrder::p) = d.beta - w0.cross(d.alpha) - f0 * interval.dt_s();
	J.segment<3>(StateOrder::phi) = w1 - d.gamma.conjugate() * w0;
	J.segment<3>(StateOrder::v) = d.gamma * f1 - f0 - w0.cross(d.beta);
	return J;
}

ImuTimeShift::Jacobian significantShiftJacobian(const ImuPreintegration& interval)
{
	ImuTimeShift::Jacobian J = shiftJacobian(interval);
	if (!changes(interval, J.segment<3>(StateOrder::phi), &ImuSample::gyro_rad_s)) J.segment<3>(StateOrder::phi).setZero();
	if (!changes(interval, J.segment<3>(StateOrder::v), &ImuSample::acc_m_s2))
	{
		J.segment<3>(StateOrder::p).setZero();
		J.segment<3>(StateOrder::v).setZero();
	}
	return J;
}

WheelTimeShift::Jacobian shiftJacobian(const WheelPreintegration& interval, const OdometerTwist& begin, const OdometerTwist& end)
{
	WheelTimeShift::Jacobian J;
	J.head<3>() = interval.dR() * end.v_m_s - begin.v_m_s - begin.w_rad_s.cross(interval.dp());
	J.tail<3>() = end.w_rad_s - interval.dR().conjugate() * begin.w_rad_s;
	return J;
}

WheelTimeShift::Jacobian shiftJacobian(const WheelPreintegration& interval)
{
	if (interval.segments().empty()) return WheelTimeShift::Jacobian::Zero();
	const WheelIntrinsics& k = interval.intrinsics();
	return shiftJacobian(interval, twistAt(interval.segments().front(), k), twistAt(interval.segments().back(), k));
}
}  // namespace viwo
