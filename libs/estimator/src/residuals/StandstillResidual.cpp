#include "residuals/StandstillResidual.h"

#include "StateOrder.h"

namespace viwo
{
namespace
{
constexpr int motion_size = StateOrder::size - StateOrder::v;
}  // namespace

StandstillResidual::StandstillResidual(double sigma_v_m_s) : LocalCost(3, {BlockShape::euclidean(motion_size)}), sigma_v_m_s_(sigma_v_m_s)
{
}

bool StandstillResidual::evaluateLocal(double const* const* x, double* residuals, double** jacobians) const
{
	const Eigen::Map<const Eigen::Vector3d> v_WB(x[0]);
	Eigen::Map<Eigen::Vector3d>{residuals} = v_WB / sigma_v_m_s_;
	if (!jacobians || !jacobians[0]) return true;

	Eigen::Map<Eigen::Matrix<double, 3, motion_size, Eigen::RowMajor>> J(jacobians[0]);
	J.setZero();
	J.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / sigma_v_m_s_;
	return true;
}
}  // namespace viwo
