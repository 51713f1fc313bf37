#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace viwo
{
/** A rigid transform T_ab: x_a = R * x_b + p, with R = R_ab (unit quaternion, Hamilton) and p = p_ab in metres. */
struct Pose3
{
	Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
	Eigen::Vector3d p = Eigen::Vector3d::Zero();

	Pose3() = default;
	Pose3(const Eigen::Quaterniond& R_ab, const Eigen::Vector3d& p_ab) : R(R_ab), p(p_ab) {}
	Pose3(const Eigen::Matrix3d& R_ab, const Eigen::Vector3d& p_ab) : R(R_ab), p(p_ab) {}

	/** T_ac = T_ab * T_bc; the rotation is renormalised. */
	Pose3 operator*(const Pose3& T_bc) const { return {(R * T_bc.R).normalized(), R * T_bc.p + p}; }
	Eigen::Vector3d operator*(const Eigen::Vector3d& x_b) const { return R * x_b + p; }
	Pose3 inverse() const { return {R.conjugate(), -(R.conjugate() * p)}; }
};

/** Yaw (rad) of R in the z-y-x convention of MRPT's CPose3D. */
inline double yawOf(const Eigen::Quaterniond& R)
{
	const Eigen::Matrix3d M = R.toRotationMatrix();
	return std::atan2(M(1, 0), M(0, 0));
}

/** T_O_C of a camera that looks along O's x axis: optical axes z forward, x right, y down (yaw -90, pitch 0, roll -90 deg). */
inline Eigen::Quaterniond forwardOpticalAxes()
{
	Eigen::Matrix3d R_OC;
	R_OC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
	return Eigen::Quaterniond(R_OC);
}
}  // namespace viwo
