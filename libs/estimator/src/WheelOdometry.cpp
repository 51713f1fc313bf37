#include "WheelOdometry.h"

#include "WheelPreintegration.h"

#include <viwo/core/So3.h>

namespace viwo
{
WheelOdometry::WheelOdometry(const EstimatorOptions& options, const WheelIntrinsics& nominal) : options_(options), nominal_(nominal) {}

void WheelOdometry::reset(const Pose3& T_WO)
{
	T_WO_ = T_WO;
	white_.setZero();
	by_intrinsics_.setZero();
}

void WheelOdometry::add(const WheelPreintegration& interval)
{
	// p <- p + R dp, R <- R dR: the same chain as within an interval (Niu et al. Eq. 7), from interval to interval.
	const Eigen::Matrix3d R_WO = T_WO_.R.toRotationMatrix();
	Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Identity(), B = A;
	A.topRightCorner<3, 3>() = -R_WO * so3::skew(interval.dp());
	A.bottomRightCorner<3, 3>() = interval.dR().toRotationMatrix().transpose();
	B.topLeftCorner<3, 3>() = R_WO;
	white_ = A * white_ * A.transpose() + B * interval.covariance() * B.transpose();
	by_intrinsics_ = A * by_intrinsics_ + B * interval.intrinsicsJacobian();
	T_WO_ = T_WO_ * Pose3(interval.dR(), interval.dp());
}

Eigen::Matrix<double, 6, 6> WheelOdometry::covariance() const
{
	const PriorOptions& p = options_.priors;
	const Eigen::Vector3d sigma(p.wheel_scale, p.wheel_scale, p.track_relative * nominal_.track_m);
	const Eigen::Matrix<double, 6, 3> J = by_intrinsics_ * sigma.asDiagonal();
	return white_ + J * J.transpose();
}
}  // namespace viwo
