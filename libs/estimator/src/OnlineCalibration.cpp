#include "OnlineCalibration.h"

#include "ImuPreintegration.h"
#include "StateOrder.h"
#include "WheelPreintegration.h"

#include <viwo/core/So3.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
// With so much of it, a typical robot's measurements have more to say than the priors.
constexpr double kEnoughTravel_m = 1;
constexpr double kEnoughTurning_rad = M_PI / 2;
constexpr double kEnoughRateChange_rad_s = 0.5;
constexpr double kEnoughSpeedChange_m_s = 0.5;
/** Slower turns may be the gyro's bias. */
constexpr double kTurns_rad_s = 0.05;
/** Between the ends of an interval; several deviations of what states and IMU say of it. */
constexpr double kSpeedChange_m_s = 5e-3;

OdometerTwist twistOf(const Frame& frame, const ImuSample& sample, const Pose3& T_OB)
{
	const NavState s = frame.state();
	const Eigen::Vector3d w_O = T_OB.R * (sample.gyro_rad_s - s.b_g);
	const Eigen::Vector3d v_B_O = T_OB.R * (s.T_WB.R.conjugate() * s.v_WB);
	return {v_B_O - w_O.cross(T_OB.p), w_O};
}
}  // namespace

bool rolled(const WheelPreintegration& wheels)
{
	return std::any_of(wheels.segments().begin(), wheels.segments().end(),
	                   [](const WheelSegment& s) { return s.v_left_m_s != 0 || s.v_right_m_s != 0; });
}

CalibrationFreedom freedomOf(const Window& w)
{
	const Excitation& e = w.excitation;
	const bool rates = e.turn_rate_change_rad_s >= kEnoughRateChange_rad_s;
	CalibrationFreedom f;
	if (w.options.freeMounting())
	{
		f.yaw = e.travel_m >= kEnoughTravel_m;
		f.lever_arm = f.tilt = e.turned_rad >= kEnoughTurning_rad;
	}
	f.camera_offset = w.options.freeCameraOffset() && rates;
	f.wheel_offset = w.options.freeWheelOffset() && (rates || e.speed_change_m_s >= kEnoughSpeedChange_m_s);
	return f;
}

WheelTimeShift::Jacobian significantWheelShift(const Frame& before, const Frame& after, const Pose3& T_OB)
{
	WheelTimeShift::Jacobian J = WheelTimeShift::Jacobian::Zero();
	const Interval& interval = after.interval;
	if (!interval.imu || !interval.wheels || interval.imu->samples().empty() || !rolled(*interval.wheels)) return J;
	const std::vector<ImuSample>& samples = interval.imu->samples();
	J = shiftJacobian(*interval.wheels, twistOf(before, samples.front(), T_OB), twistOf(after, samples.back(), T_OB));
	if (significantShiftJacobian(*interval.imu).segment<3>(StateOrder::phi).isZero(0)) J.tail<3>().setZero();
	if (J.head<3>().norm() < kSpeedChange_m_s) J.head<3>().setZero();
	return J;
}

void noteExcitation(Window& w, const Frame& before, const Frame& keyframe, bool camera_tracks)
{
	const Interval& interval = keyframe.interval;
	if (!interval.imu || keyframe.standing) return;
	Excitation& e = w.excitation;
	e.turn_rate_change_rad_s += significantShiftJacobian(*interval.imu).segment<3>(StateOrder::phi).norm();
	const double turned_rad = so3::log(interval.imu->corrected(interval.imu->b_a(), keyframe.state().b_g).gamma).norm();
	if (turned_rad > kTurns_rad_s * interval.imu->dt_s()) e.turned_rad += turned_rad;
	if (!interval.wheels) return;
	e.speed_change_m_s += significantWheelShift(before, keyframe, w.calibration.T_OB).head<3>().norm();
	if (camera_tracks) e.travel_m += interval.wheels->distance_m();
}
}  // namespace viwo
