#include "residuals/PlaneResidual.h"

#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>

namespace viwo
{
namespace
{
constexpr size_t mounting_block = 2;
}  // namespace

PlaneResidual::PlaneResidual(const Pose3& T_BO, double sigma_tilt_rad, double sigma_height_m)
    : LocalCost(3, {BlockShape::pose(), BlockShape::euclidean(3)}),
      T_BO_(T_BO),
      weights_(1 / sigma_tilt_rad, 1 / sigma_tilt_rad, 1 / sigma_height_m)
{
}

PlaneResidual::PlaneResidual(double sigma_tilt_rad, double sigma_height_m)
    : LocalCost(3, {BlockShape::pose(), BlockShape::euclidean(3), BlockShape::pose()}),
      weights_(1 / sigma_tilt_rad, 1 / sigma_tilt_rad, 1 / sigma_height_m)
{
}

bool PlaneResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Pose3 T_WB = poseFromBlock(x[0]);
	const Pose3 T_BO = shapes().size() > mounting_block ? poseFromBlock(x[mounting_block]) : T_BO_;
	const Eigen::Vector3d tilt(x[1][0], x[1][1], 0);
	const double height = x[1][2];

	const Eigen::Matrix3d R_WB = T_WB.R.toRotationMatrix();
	const Eigen::Matrix3d R_OB = T_BO.R.conjugate().toRotationMatrix();
	const Eigen::Matrix3d R_tilt = so3::exp(tilt);
	const Eigen::Vector3d n_W = R_tilt.col(2);
	const Eigen::Vector3d n_B = R_WB.transpose() * n_W;
	const Eigen::Vector3d p_WO = T_WB * T_BO.p;
	Eigen::Map<Eigen::Vector3d> r(residuals);
	r << (R_OB * n_B).head<2>(), n_W.dot(p_WO) - height;
	r.array() *= weights_.array();
	if (!jacobians) return true;

	if (jacobians[0])
	{
		Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>> J(jacobians[0]);
		J.setZero();
		J.block<2, 3>(0, 3) = (R_OB * so3::skew(n_B)).topRows<2>();
		J.row(2) << n_W.transpose(), -n_B.transpose() * so3::skew(T_BO.p);
		J = weights_.asDiagonal() * J.eval();
	}
	if (jacobians[1])
	{
		const Eigen::Matrix<double, 3, 2> dn_W = (-R_tilt * so3::skew(Eigen::Vector3d::UnitZ()) * so3::rightJacobian(tilt)).leftCols<2>();
		Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> J(jacobians[1]);
		J << (R_OB * R_WB.transpose() * dn_W).topRows<2>(), Eigen::Vector2d::Zero(), p_WO.transpose() * dn_W, -1;
		J = weights_.asDiagonal() * J.eval();
	}
	if (shapes().size() > mounting_block && jacobians[mounting_block])
	{
		Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>> J(jacobians[mounting_block]);
		J.setZero();
		J.block<2, 3>(0, 3) = so3::skew(R_OB * n_B).topRows<2>();
		J.row(2).head<3>() = n_B.transpose();
		J = weights_.asDiagonal() * J.eval();
	}
	return true;
}
}  // namespace viwo
