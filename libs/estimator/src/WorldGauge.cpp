#include "WorldGauge.h"

#include <viwo/core/So3.h>

namespace viwo
{
void WorldGauge::startAt(const Pose3& T_WO, const Matrix6& covariance)
{
	// Roll and pitch of the start are not part of the gauge: gravity gives them anew.
	Eigen::Matrix<double, 4, 6> J = Eigen::Matrix<double, 4, 6>::Zero();
	J.topLeftCorner<3, 3>().setIdentity();
	J.bottomRightCorner<1, 3>() = T_WO.R.toRotationMatrix().row(2);
	p_WO_start_ = T_WO.p;
	covariance_ = J * covariance * J.transpose();
}

WorldGauge::Matrix6 WorldGauge::covarianceOf(const Pose3& T_WO, const Matrix6& in_window) const
{
	Eigen::Matrix<double, 6, 4> J = Eigen::Matrix<double, 6, 4>::Zero();
	J.topLeftCorner<3, 3>().setIdentity();
	J.topRightCorner<3, 1>() = Eigen::Vector3d::UnitZ().cross(T_WO.p - p_WO_start_);
	J.bottomRightCorner<3, 1>() = T_WO.R.conjugate() * Eigen::Vector3d::UnitZ();
	return in_window + J * covariance_ * J.transpose();
}

Eigen::Matrix<double, 6, 6> vehicleCovariance(const Pose3& T_WB, const Pose3& T_BO, const Eigen::Matrix<double, 6, 6>& of_T_WB)
{
	Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Zero();
	J.topLeftCorner<3, 3>().setIdentity();
	J.topRightCorner<3, 3>() = -T_WB.R.toRotationMatrix() * so3::skew(T_BO.p);
	J.bottomRightCorner<3, 3>() = T_BO.R.toRotationMatrix().transpose();
	return J * of_T_WB * J.transpose();
}
}  // namespace viwo
