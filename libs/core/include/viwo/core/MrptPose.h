#pragma once

#include <mrpt/poses/CPose3D.h>
#include <viwo/core/Pose3.h>

namespace viwo
{
/** The same transform T_ab as MRPT's class (yaw-pitch-roll about z, y, x). */
inline mrpt::poses::CPose3D toMrpt(const Pose3& T_ab)
{
	mrpt::math::CMatrixDouble44 M;
	M.setIdentity();
	const Eigen::Matrix3d R = T_ab.R.toRotationMatrix();
	for (int r = 0; r < 3; r++)
	{
		for (int c = 0; c < 3; c++) M(r, c) = R(r, c);
		M(r, 3) = T_ab.p[r];
	}
	return mrpt::poses::CPose3D(M);
}

inline Pose3 fromMrpt(const mrpt::poses::CPose3D& T_ab)
{
	const auto& M = T_ab.getRotationMatrix();
	Eigen::Matrix3d R;
	for (int r = 0; r < 3; r++)
		for (int c = 0; c < 3; c++) R(r, c) = M(r, c);
	return {Eigen::Quaterniond(R).normalized(), Eigen::Vector3d(T_ab.x(), T_ab.y(), T_ab.z())};
}
}  // namespace viwo
