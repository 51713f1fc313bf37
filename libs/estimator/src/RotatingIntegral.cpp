#include "RotatingIntegral.h"

#include <viwo/core/So3.h>

#include <cmath>

namespace viwo::rotating
{
namespace
{
/** c_m(x) = sum_i (-x)^i / (2 i + m)! with x = |phi|^2: c_1 = sin / angle, c_2 = (1 - cos) / angle^2 and so on, without their cancellation.
 */
struct Coefficient
{
	double value = 0;
	double derivative = 0;  //!< with respect to x
};

Coefficient coefficient(int m, double x)
{
	double term = 1;
	for (int i = 2; i <= m; ++i) term /= i;
	Coefficient c{term, 0};
	// `term` becomes (-x)^i / (2 i + m)! and `slope` its derivative; past x < (2 i)^2 the terms fall faster than geometrically.
	for (int i = 1; i < 100; ++i)
	{
		const double divisor = static_cast<double>(2 * i + m) * static_cast<double>(2 * i + m - 1);
		const double slope = -term * i / divisor;
		term *= -x / divisor;
		c.value += term;
		c.derivative += slope;
		if (std::abs(term) < 1e-18 && std::abs(slope) < 1e-18) break;
	}
	return c;
}

double inverseFactorial(int n)
{
	double f = 1;
	for (int i = 2; i <= n; ++i) f /= i;
	return f;
}
}  // namespace

Eigen::Matrix3d gamma(int n, const Eigen::Vector3d& phi)
{
	const double x = phi.squaredNorm();
	const Eigen::Matrix3d K = so3::skew(phi);
	return inverseFactorial(n) * Eigen::Matrix3d::Identity() + coefficient(n + 1, x).value * K + coefficient(n + 2, x).value * K * K;
}

Eigen::Matrix3d gammaTimesVectorDerivative(int n, const Eigen::Vector3d& phi, const Eigen::Vector3d& a)
{
	const double x = phi.squaredNorm();
	const Coefficient c1 = coefficient(n + 1, x), c2 = coefficient(n + 2, x);
	const Eigen::Vector3d phi_a = phi.cross(a);
	const Eigen::Vector3d phi_phi_a = phi.cross(phi_a);
	Eigen::Matrix3d D = -c1.value * so3::skew(a);
	D += c2.value * (phi * a.transpose() + phi.dot(a) * Eigen::Matrix3d::Identity() - 2. * a * phi.transpose());
	D += 2. * (c1.derivative * phi_a + c2.derivative * phi_phi_a) * phi.transpose();
	return D;
}
}  // namespace viwo::rotating
