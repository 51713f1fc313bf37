#include "residuals/StandstillResidual.h"

#include "StateOrder.h"

namespace viwo
{
namespace
{
constexpr int motion_size = StateOrder::size - StateOrder::v;
constexpr int b_g = StateOrder::b_g - StateOrder::v;
}  // namespace

StandstillResidual::StandstillResidual(double sigma_v_m_s) : LocalCost(3, {BlockShape::euclidean(motion_size)}), sigma_v_m_s_(sigma_v_m_s)
{
}

StandstillResidual::StandstillResidual(double sigma_v_m_s, const Eigen::Vector3d& gyro_mean_rad_s, double sigma_gyro_rad_s)
    : LocalCost(6, {BlockShape::euclidean(motion_size)}),
      sigma_v_m_s_(sigma_v_m_s),
      gyro_mean_rad_s_(gyro_mean_rad_s),
      sigma_gyro_rad_s_(sigma_gyro_rad_s)
{
}

bool StandstillResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const bool with_gyro = num_residuals() == 6;
	const Eigen::Map<const Eigen::Vector3d> v_WB(x[0]);
	const Eigen::Map<const Eigen::Vector3d> gyro_bias(x[0] + b_g);
	Eigen::Map<Eigen::Vector3d>{residuals} = v_WB / sigma_v_m_s_;
	if (with_gyro) Eigen::Map<Eigen::Vector3d>{residuals + 3} = (gyro_mean_rad_s_ - gyro_bias) / sigma_gyro_rad_s_;
	if (!jacobians || !jacobians[0]) return true;

	Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, motion_size, Eigen::RowMajor>> J(jacobians[0], num_residuals(), motion_size);
	J.setZero();
	J.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / sigma_v_m_s_;
	if (with_gyro) J.block<3, 3>(3, b_g) = -Eigen::Matrix3d::Identity() / sigma_gyro_rad_s_;
	return true;
}
}  // namespace viwo
