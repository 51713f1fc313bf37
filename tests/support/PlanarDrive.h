#pragma once

#include <viwo/core/ImuSample.h>
#include <viwo/core/Pose3.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>
#include <viwo/core/WheelSample.h>

#include <cmath>

namespace viwo::test
{
/** A robot on level ground, whose forward speed and yaw rate swing about a mean: poses, IMU and wheel readings from closed forms (the
 * position from Simpson's rule at 1 ms). */
struct PlanarDrive
{
	double v_m_s = 0.15, v_swing_m_s = 0, v_rate_rad_s = 3;
	double w_rad_s = 0.15, w_swing_rad_s = 0, w_rate_rad_s = 2;
	double start_yaw_rad = 0.4;
	Pose3 T_OB;
	Eigen::Vector3d b_a = Eigen::Vector3d::Zero(), b_g = Eigen::Vector3d::Zero();
	WheelIntrinsics wheels;
	double gravity_m_s2 = 9.81;

	double speed(double t) const { return v_m_s + v_swing_m_s * std::sin(v_rate_rad_s * t); }
	double acceleration(double t) const { return v_swing_m_s * v_rate_rad_s * std::cos(v_rate_rad_s * t); }
	double yawRate(double t) const { return w_rad_s + w_swing_rad_s * std::cos(w_rate_rad_s * t); }
	double yawAcceleration(double t) const { return -w_swing_rad_s * w_rate_rad_s * std::sin(w_rate_rad_s * t); }
	double yaw(double t) const { return start_yaw_rad + w_rad_s * t + w_swing_rad_s / w_rate_rad_s * std::sin(w_rate_rad_s * t); }
	double travel(double t) const { return v_m_s * t + v_swing_m_s / v_rate_rad_s * (1 - std::cos(v_rate_rad_s * t)); }

	Pose3 T_WO(double t) const
	{
		const int steps = 2 * std::max(1, static_cast<int>(std::ceil(std::abs(t) * 500)));
		Eigen::Vector3d p = Eigen::Vector3d::Zero();
		for (int i = 0; i <= steps; ++i)
		{
			const double s = t * i / steps, weight = i == 0 || i == steps ? 1 : (i % 2 == 1 ? 4 : 2);
			p += weight * speed(s) * Eigen::Vector3d(std::cos(yaw(s)), std::sin(yaw(s)), 0);
		}
		return {so3::expQuaternion({0, 0, yaw(t)}), p * t / (3.0 * steps)};
	}
	Pose3 T_WB(double t) const { return T_WO(t) * T_OB; }
	Eigen::Vector3d v_WB(double t) const
	{
		const Eigen::Vector3d v_O(speed(t), 0, 0), w(0, 0, yawRate(t));
		return so3::expQuaternion({0, 0, yaw(t)}) * (v_O + w.cross(T_OB.p));
	}
	ImuSample imu(int64_t t_ns) const
	{
		const double t = secondsBetween(0, t_ns);
		const Eigen::Vector3d w(0, 0, yawRate(t)), w_dot(0, 0, yawAcceleration(t));
		const Eigen::Vector3d a_O = Eigen::Vector3d(acceleration(t), 0, 0) + w.cross(Eigen::Vector3d(speed(t), 0, 0));
		const Eigen::Vector3d a_B = a_O + w_dot.cross(T_OB.p) + w.cross(w.cross(T_OB.p)) + Eigen::Vector3d(0, 0, gravity_m_s2);
		return {t_ns, T_OB.R.conjugate() * a_B + b_a, T_OB.R.conjugate() * w + b_g};
	}
	/** As nominal radii tell them: over the interval that ends at t_ns. */
	WheelSample wheel(int64_t t_ns, int64_t period_ns) const
	{
		const double t1 = secondsBetween(0, t_ns), t0 = secondsBetween(0, t_ns - period_ns), dt = t1 - t0;
		const WheelSample s = wheelSampleFromTwist(t_ns, {(travel(t1) - travel(t0)) / dt, (yaw(t1) - yaw(t0)) / dt}, wheels.track_m);
		return {t_ns, s.v_left_m_s / wheels.k_left, s.v_right_m_s / wheels.k_right};
	}
};
}  // namespace viwo::test
