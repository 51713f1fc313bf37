#include "Linearisation.h"

#include <viwo/core/So3.h>

#include <Eigen/Cholesky>
#include <cmath>

namespace viwo::sfm
{
Linearised linearise(const Eigen::Vector4d& X, const Pose3& T_r_ck, const Eigen::Vector3d& bearing)
{
	const Eigen::Matrix3d R_ck_r = T_r_ck.R.conjugate().toRotationMatrix();
	const Eigen::Vector3d f = directionOf(X, T_r_ck);
	const double depth = bearing.dot(f);
	const Eigen::Matrix<double, 2, 3> B = tangentBasis(bearing).transpose();
	const Eigen::Matrix<double, 2, 3> J_f = (B - (B * f / depth) * bearing.transpose()) / depth;
	Linearised L;
	L.camera.leftCols<3>() = -X.w() * J_f * R_ck_r;
	L.camera.rightCols<3>() = J_f * so3::skew(f);
	L.point.leftCols<3>() = J_f * R_ck_r;
	L.point.col(3) = -J_f * R_ck_r * T_r_ck.p;
	return L;
}

double inverseDistanceSigma(const ScenePoint& point, const std::vector<std::optional<Pose3>>& T_r_ck, double sigma_rad)
{
	const Eigen::Vector4d& X = point.X.value();
	Eigen::Matrix4d H = X * X.transpose();  // the direction along X is no degree of freedom
	for (const Observation& o : point.track.observations)
	{
		const Linearised L = linearise(X, T_r_ck[static_cast<size_t>(o.frame)].value(), o.bearing);
		H += L.point.transpose() * L.point;
	}
	const double distance = X.head<3>().norm();
	Eigen::Vector4d gradient;
	gradient << -X.w() / std::pow(distance, 3) * X.head<3>(), 1 / distance;
	return sigma_rad * std::sqrt(gradient.dot(H.ldlt().solve(gradient)));
}
}  // namespace viwo::sfm
