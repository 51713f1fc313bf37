#include "residuals/BlockAlgebra.h"

#include <viwo/core/So3.h>

namespace viwo
{
Pose3 poseFromBlock(const double* block)
{
	return {Eigen::Quaterniond(Eigen::Map<const Eigen::Quaterniond>(block + 3)), Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(block))};
}

void poseToBlock(const Pose3& T, double* block)
{
	Eigen::Map<Eigen::Vector3d>{block} = T.p;
	Eigen::Map<Eigen::Vector4d>{block + 3} = T.R.coeffs();
}

Pose3 posePlus(const Pose3& T, const Vector6d& delta)
{
	return {(T.R * so3::expQuaternion(delta.tail<3>())).normalized(), T.p + delta.head<3>()};
}

Vector6d poseMinus(const Pose3& y, const Pose3& x)
{
	Vector6d delta;
	delta << y.p - x.p, so3::log(Eigen::Quaterniond(x.R.conjugate() * y.R));
	return delta;
}

void blockPlus(const BlockShape& shape, const double* x, const double* delta, double* result)
{
	if (shape.kind == BlockKind::pose)
	{
		poseToBlock(posePlus(poseFromBlock(x), Eigen::Map<const Vector6d>(delta)), result);
		return;
	}
	for (int i = 0; i < shape.ambient; ++i) result[i] = x[i] + delta[i];
}

void blockMinus(const BlockShape& shape, const double* y, const double* x, double* delta)
{
	if (shape.kind == BlockKind::pose)
	{
		Eigen::Map<Vector6d>{delta} = poseMinus(poseFromBlock(y), poseFromBlock(x));
		return;
	}
	for (int i = 0; i < shape.ambient; ++i) delta[i] = y[i] - x[i];
}
}  // namespace viwo
