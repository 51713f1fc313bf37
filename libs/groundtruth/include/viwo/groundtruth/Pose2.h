#pragma once

#include <Eigen/Core>
#include <cmath>

namespace viwo::gt
{
/** Angle in (-pi, pi]. */
inline double wrapped(double angle_rad)
{
	return std::remainder(angle_rad, 2 * M_PI);
}

/** A planar rigid transform T_ab: x_a = R(yaw) x_b + p. m, rad. */
struct Pose2
{
	Eigen::Vector2d p = Eigen::Vector2d::Zero();
	double yaw = 0;

	Pose2() = default;
	Pose2(double x, double y, double yaw_rad) : p(x, y), yaw(yaw_rad) {}
	Pose2(const Eigen::Vector2d& p_ab, double yaw_rad) : p(p_ab), yaw(yaw_rad) {}

	Eigen::Matrix2d R() const
	{
		const double c = std::cos(yaw), s = std::sin(yaw);
		return (Eigen::Matrix2d() << c, -s, s, c).finished();
	}
	Eigen::Vector2d operator*(const Eigen::Vector2d& x_b) const { return R() * x_b + p; }
	Pose2 operator*(const Pose2& T_bc) const { return {R() * T_bc.p + p, wrapped(yaw + T_bc.yaw)}; }
	Pose2 inverse() const { return {-(R().transpose() * p), -yaw}; }
};

/** T_ab^-1 T_ac: c seen from b. */
inline Pose2 between(const Pose2& T_ab, const Pose2& T_ac)
{
	return T_ab.inverse() * T_ac;
}
}  // namespace viwo::gt
