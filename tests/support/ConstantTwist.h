#pragma once

#include <ImuPreintegration.h>
#include <WheelPreintegration.h>

#include <viwo/core/Pose3.h>
#include <viwo/core/So3.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

/** A body that turns about W's vertical at a constant rate and keeps its velocity in its own axes: a closed-form trajectory, of which the
 * IMU reads constants. O may be tilted against B, and has a lever arm. */
namespace viwo::test
{
constexpr double gravity = 9.81;

struct ConstantTwist
{
	Pose3 T_WO0;  //!< level: z of O is W's z
	Pose3 T_BO;
	double v_m_s = 0.15;
	double w_rad_s = 0.15;
	Eigen::Vector3d b_a = Eigen::Vector3d::Zero(), b_g = Eigen::Vector3d::Zero();
	WheelIntrinsics wheels;

	Pose3 T_WO(double t) const
	{
		const Eigen::Vector3d turn(0, 0, w_rad_s * t);
		return T_WO0 * Pose3(so3::expQuaternion(turn), so3::leftJacobian(turn) * Eigen::Vector3d(v_m_s * t, 0, 0));
	}
	Pose3 T_WB(double t) const { return T_WO(t) * T_BO.inverse(); }
	/** v_B = v_O + w x (p_B - p_O). */
	Eigen::Vector3d v_WB(double t) const
	{
		const Pose3 T = T_WO(t);
		const Eigen::Vector3d p_OB = T_BO.inverse().p;
		return T.R * (Eigen::Vector3d(v_m_s, 0, 0) + Eigen::Vector3d(0, 0, w_rad_s).cross(p_OB));
	}
	Eigen::VectorXd motion(double t) const
	{
		Eigen::VectorXd m(9);
		m << v_WB(t), b_a, b_g;
		return m;
	}
	ImuSample imu(double t) const
	{
		const Eigen::Matrix3d R_BW = T_WB(t).R.conjugate().toRotationMatrix();
		const Eigen::Vector3d w_W(0, 0, w_rad_s);
		return {std::llround(t * 1e9), R_BW * (w_W.cross(v_WB(t)) + Eigen::Vector3d(0, 0, gravity)) + b_a, R_BW * w_W + b_g};
	}
	/** At 200 Hz, preintegrated at the given biases. */
	ImuPreintegration imuBetween(double t0, double t1, const Eigen::Vector3d& at_b_a, const Eigen::Vector3d& at_b_g) const
	{
		const int steps = static_cast<int>(std::lround((t1 - t0) * 200));
		std::vector<ImuSample> samples;
		for (int k = 0; k <= steps; ++k) samples.push_back(imu(t0 + (t1 - t0) * k / steps));
		ImuPreintegration preintegration(ImuNoise(), at_b_a, at_b_g);
		preintegration.integrate(samples);
		return preintegration;
	}
	/** In 50 ms segments, preintegrated at the given intrinsics. */
	WheelPreintegration wheelsBetween(double t0, double t1, const WheelIntrinsics& at) const
	{
		const int steps = static_cast<int>(std::lround((t1 - t0) * 20));
		const double left = (v_m_s - 0.5 * wheels.track_m * w_rad_s) / wheels.k_left;
		const double right = (v_m_s + 0.5 * wheels.track_m * w_rad_s) / wheels.k_right;
		WheelPreintegration preintegration(WheelNoise(), at);
		for (int k = 0; k < steps; ++k) preintegration.integrate({(t1 - t0) / steps, left, right});
		return preintegration;
	}
};
}  // namespace viwo::test
