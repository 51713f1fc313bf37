#include <gtest/gtest.h>
#include <viwo/core/So3.h>

#include <Eigen/LU>
#include <iostream>
#include <random>
#include <vector>

using namespace viwo;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace
{
std::vector<Vector3d> rotationVectors()
{
	std::mt19937 generator(7);
	std::normal_distribution<double> normal;
	std::vector<Vector3d> vectors{Vector3d::Zero(), Vector3d(1e-200, 0, 0), Vector3d(0, 0, M_PI - 1e-6), Vector3d(-M_PI + 1e-9, 0, 0)};
	for (double theta : {1e-12, 1e-8, 1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.299, 0.301, 0.5, 0.999, 1.001, 2.0, 3.0, M_PI - 1e-3, M_PI - 1e-7})
		for (int i = 0; i < 5; i++)
			vectors.push_back(theta * Vector3d(normal(generator), normal(generator), normal(generator)).normalized());
	return vectors;
}

/** Central differences of f: R^3 -> R^3 at 0. */
template <class Function>
Matrix3d numericJacobian(const Function& f)
{
	constexpr double h = 1e-5;
	Matrix3d J;
	for (int i = 0; i < 3; i++) J.col(i) = (f(h * Vector3d::Unit(i)) - f(-h * Vector3d::Unit(i))) / (2 * h);
	return J;
}
}  // namespace

TEST(So3, SkewIsTheCrossProduct)
{
	const Vector3d a(1, -2, 3), b(0.4, 5, -6);
	EXPECT_LT((so3::skew(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(So3, ExpAgreesWithAngleAxisAndQuaternion)
{
	for (const auto& phi : rotationVectors())
	{
		const double theta = phi.norm();
		const Matrix3d expected = theta > 0 ? Eigen::AngleAxisd(theta, phi / theta).toRotationMatrix() : Matrix3d::Identity();
		EXPECT_LT((so3::exp(phi) - expected).norm(), 2e-15) << phi.transpose();
		EXPECT_LT((so3::expQuaternion(phi).toRotationMatrix() - expected).norm(), 2e-15) << phi.transpose();
	}
}

TEST(So3, LogInvertsExpToMachinePrecision)
{
	double worst = 0;
	for (const auto& phi : rotationVectors())
	{
		const double scale = std::max(phi.norm(), 1e-300);
		worst = std::max(worst, (so3::log(so3::expQuaternion(phi)) - phi).norm() / scale);
		EXPECT_LT((so3::log(so3::exp(phi)) - phi).norm(), 1e-14) << phi.transpose();
	}
	std::cout << "[measured] relative error of Log(Exp): " << worst << "\n";
	EXPECT_LT(worst, 1e-14);
}

TEST(So3, BothSignsOfAQuaternionHaveOneLog)
{
	for (const auto& phi : rotationVectors())
	{
		Eigen::Quaterniond q = so3::expQuaternion(phi), minus_q = q;
		minus_q.coeffs() *= -1;
		EXPECT_EQ(so3::log(q), so3::log(minus_q));
	}
	const Eigen::Quaterniond half_turn(0, 0, -0.6, 0.8), other(0, 0, 0.6, -0.8);
	EXPECT_EQ(so3::log(half_turn), so3::log(other));
	EXPECT_NEAR(so3::log(half_turn).norm(), M_PI, 1e-15);
}

TEST(So3, LogIsAtMostPi)
{
	const Vector3d phi = Vector3d(1, 2, -2) / 3 * 5.0;
	const Vector3d result = so3::log(so3::expQuaternion(phi));
	EXPECT_NEAR(result.norm(), 2 * M_PI - 5.0, 1e-14);
	EXPECT_LT((so3::exp(result) - so3::exp(phi)).norm(), 1e-14);
}

TEST(So3, JacobiansAgreeWithDifferencesOfTheGroup)
{
	double worst = 0;
	for (const auto& phi : rotationVectors())
	{
		const Eigen::Quaterniond inverse = so3::expQuaternion(-phi);
		const Matrix3d numeric_right = numericJacobian([&](const Vector3d& d) { return so3::log(inverse * so3::expQuaternion(phi + d)); });
		const Matrix3d numeric_left = numericJacobian([&](const Vector3d& d) { return so3::log(so3::expQuaternion(phi + d) * inverse); });
		worst = std::max(worst, (so3::rightJacobian(phi) - numeric_right).norm() / numeric_right.norm());
		worst = std::max(worst, (so3::leftJacobian(phi) - numeric_left).norm() / numeric_left.norm());
	}
	std::cout << "[measured] relative error of the Jacobians: " << worst << "\n";
	EXPECT_LT(worst, 1e-9);
}

TEST(So3, InverseJacobiansInvert)
{
	double worst = 0;
	for (const auto& phi : rotationVectors())
	{
		worst = std::max(worst, (so3::leftJacobianInverse(phi) * so3::leftJacobian(phi) - Matrix3d::Identity()).norm());
		worst = std::max(worst, (so3::rightJacobian(phi) * so3::rightJacobianInverse(phi) - Matrix3d::Identity()).norm());
	}
	std::cout << "[measured] J J^-1 - I: " << worst << "\n";
	EXPECT_LT(worst, 1e-14);
}

TEST(So3, LeftJacobianIsTheMeanRotation)
{
	for (const auto& phi : rotationVectors())
	{
		Matrix3d sum = Matrix3d::Zero();
		constexpr int n = 2000;
		for (int i = 0; i < n; i++) sum += so3::exp((i + 0.5) / n * phi) / n;
		EXPECT_LT((so3::leftJacobian(phi) - sum).norm(), 1e-6);
	}
}
