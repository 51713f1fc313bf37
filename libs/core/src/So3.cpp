#include <viwo/core/So3.h>

#include <cmath>

namespace viwo::so3
{
namespace
{
/** sin(x) / x */
double sinc(double x)
{
	return x == 0 ? 1 : std::sin(x) / x;
}

/** (theta - sin(theta)) / theta^3. The quotient cancels below about 1 rad: its Taylor series there, to 1e-17. */
double cubicCoefficient(double theta)
{
	const double t2 = theta * theta;
	if (theta > 1) return (theta - std::sin(theta)) / (t2 * theta);
	double sum = 0;
	for (int k = 17; k >= 3; k -= 2) sum = (1 - t2 * sum) / (k * (k - 1));
	return sum;
}

/** (1 - x cot(x)) / theta^2 with x = theta / 2. */
double inverseCoefficient(double theta)
{
	const double x = 0.5 * theta;
	if (theta > 0.3) return (1 - x / std::tan(x)) / (theta * theta);
	const double x2 = x * x;
	const double series = 1. / 3 + x2 * (1. / 45 + x2 * (2. / 945 + x2 * (1. / 4725 + x2 * (2. / 93555 + x2 * (1382. / 638512875)))));
	return 0.25 * series;
}

bool firstNonZeroIsNegative(const Eigen::Vector3d& v)
{
	for (int i = 0; i < 3; i++)
		if (v[i] != 0) return v[i] < 0;
	return false;
}
}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v)
{
	Eigen::Matrix3d m;
	m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
	return m;
}

Eigen::Quaterniond expQuaternion(const Eigen::Vector3d& phi)
{
	const double half = 0.5 * phi.norm();
	Eigen::Quaterniond q;
	q.w() = std::cos(half);
	q.vec() = 0.5 * sinc(half) * phi;
	return q;
}

Eigen::Matrix3d exp(const Eigen::Vector3d& phi)
{
	const double theta = phi.norm();
	const double half_sinc = sinc(0.5 * theta);
	const Eigen::Matrix3d P = skew(phi);
	return Eigen::Matrix3d::Identity() + sinc(theta) * P + 0.5 * half_sinc * half_sinc * P * P;
}

Eigen::Vector3d log(const Eigen::Quaterniond& q)
{
	const double n = q.vec().norm();
	// Of q and -q, the one of angle <= pi; at pi itself the sign is free and is fixed by the axis.
	const bool flip = q.w() < 0 || (q.w() == 0 && firstNonZeroIsNegative(q.vec()));
	const double sign = flip ? -1 : 1;
	const double w = sign * q.w();
	const double angle_over_n = n > 0 ? 2 * std::atan2(n, w) / n : 2 / w;
	return sign * angle_over_n * q.vec();
}

Eigen::Vector3d log(const Eigen::Matrix3d& R)
{
	return log(Eigen::Quaterniond(R).normalized());
}

Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi)
{
	const double theta = phi.norm();
	const double half_sinc = sinc(0.5 * theta);
	const Eigen::Matrix3d P = skew(phi);
	return Eigen::Matrix3d::Identity() + 0.5 * half_sinc * half_sinc * P + cubicCoefficient(theta) * P * P;
}

Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& phi)
{
	return leftJacobian(-phi);
}

Eigen::Matrix3d leftJacobianInverse(const Eigen::Vector3d& phi)
{
	const Eigen::Matrix3d P = skew(phi);
	return Eigen::Matrix3d::Identity() - 0.5 * P + inverseCoefficient(phi.norm()) * P * P;
}

Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& phi)
{
	return leftJacobianInverse(-phi);
}
}  // namespace viwo::so3
