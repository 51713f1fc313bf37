#include "Scene.h"

#include <viwo/core/So3.h>

#include <Eigen/Eigenvalues>

namespace viwo::sfm
{
Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& bearing)
{
	Eigen::Vector3d aside = Eigen::Vector3d::UnitX();
	if (std::abs(bearing.x()) > 0.8) aside = Eigen::Vector3d::UnitY();
	Eigen::Matrix<double, 3, 2> basis;
	basis.col(0) = bearing.cross(aside).normalized();
	basis.col(1) = bearing.cross(basis.col(0));
	return basis;
}

std::optional<Eigen::Vector2d> bearingError(const Eigen::Vector4d& X, const Pose3& T_r_ck, const Eigen::Vector3d& bearing)
{
	const Eigen::Vector3d f = directionOf(X, T_r_ck);
	const double depth = bearing.dot(f);
	if (depth <= 0) return std::nullopt;
	return Eigen::Vector2d(tangentBasis(bearing).transpose() * f / depth);
}

std::optional<Eigen::Vector4d> triangulate(const Track& track, const std::vector<std::optional<Pose3>>& T_r_ck)
{
	Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
	int views = 0;
	for (const Observation& o : track.observations)
	{
		const std::optional<Pose3>& T = T_r_ck[static_cast<size_t>(o.frame)];
		if (!T) continue;
		const Eigen::Matrix3d R = T->R.conjugate().toRotationMatrix();
		Eigen::Matrix<double, 2, 4> rows;
		rows.leftCols<3>() = tangentBasis(o.bearing).transpose() * R;
		rows.col(3) = -rows.leftCols<3>() * T->p;
		A += rows.transpose() * rows;
		++views;
	}
	if (views < 2) return std::nullopt;
	Eigen::Vector4d X = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(A).eigenvectors().col(0);
	std::optional<double> sign;
	for (const Observation& o : track.observations)
	{
		const std::optional<Pose3>& T = T_r_ck[static_cast<size_t>(o.frame)];
		if (!T) continue;
		const double depth = o.bearing.dot(directionOf(X, *T));
		if (sign && *sign * depth <= 0) return std::nullopt;
		if (!sign) sign = depth < 0 ? -1.0 : 1.0;
	}
	return Eigen::Vector4d(*sign * X);
}
}  // namespace viwo::sfm
