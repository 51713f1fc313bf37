#include "RotatingIntegral.h"

#include <gtest/gtest.h>
#include <viwo/core/So3.h>

#include <algorithm>
#include <iostream>

using namespace viwo;

namespace
{
const std::vector<Eigen::Vector3d> kTurns{{0, 0, 0},        {1e-9, 0, 2e-9}, {1e-4, -2e-4, 3e-4}, {0.01, 0.02, -0.03},
                                          {0.3, -0.2, 0.5}, {1.5, -1, 2},    {0, 0, 3.1}};
}  // namespace

TEST(RotatingIntegral, FirstIsTheLeftJacobianAndSecondItsMean)
{
	double first = 0, second = 0;
	for (const Eigen::Vector3d& turn : kTurns)
	{
		first = std::max(first, (rotating::gamma(1, turn) - so3::leftJacobian(turn)).norm());
		// Gamma_2 is the integral of (1 - s) Exp(s phi) over s in [0, 1]: Simpson's rule.
		Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
		constexpr int kSteps = 400;
		for (int i = 0; i <= kSteps; ++i)
		{
			const double s = static_cast<double>(i) / kSteps;
			const double weight = (i == 0 || i == kSteps ? 1. : i % 2 ? 4. : 2.) / (3. * kSteps);
			sum += weight * (1 - s) * so3::exp(Eigen::Vector3d(s * turn));
		}
		second = std::max(second, (rotating::gamma(2, turn) - sum).norm());
	}
	std::cout << "[measured] Gamma_1 against the left Jacobian " << first << ", Gamma_2 against quadrature " << second << "\n";
	EXPECT_LT(first, 1e-14);
	EXPECT_LT(second, 1e-10);
}

TEST(RotatingIntegral, DerivativeAgreesWithNumeric)
{
	const Eigen::Vector3d a(0.7, -1.3, 9.8);
	double worst = 0;
	for (const int n : {1, 2, 3})
	{
		for (const Eigen::Vector3d& turn : kTurns)
		{
			Eigen::Matrix3d numeric;
			for (int i = 0; i < 3; ++i)
			{
				const Eigen::Vector3d step = 1e-4 * Eigen::Vector3d::Unit(i);
				numeric.col(i) = (rotating::gamma(n, turn + step) * a - rotating::gamma(n, turn - step) * a) / 2e-4;
			}
			worst = std::max(worst, (rotating::gammaTimesVectorDerivative(n, turn, a) - numeric).norm() / numeric.norm());
		}
	}
	std::cout << "[measured] derivative of Gamma a against numeric, relative " << worst << "\n";
	EXPECT_LT(worst, 1e-8);
}
