#pragma once

#include <residuals/BlockAlgebra.h>
#include <residuals/LocalCost.h>
#include <residuals/PoseManifold.h>

#include <ceres/gradient_checker.h>
#include <viwo/core/So3.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <vector>

/** Jacobians of a LocalCost against differences through the manifold's own plus, compared by norm (true zeros defeat entry-wise
 * comparison). */
namespace viwo::test
{
using Blocks = std::vector<std::vector<double>>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline std::vector<const double*> pointers(const Blocks& x)
{
	std::vector<const double*> p;
	for (const auto& block : x) p.push_back(block.data());
	return p;
}

inline std::vector<double> block(const Pose3& T)
{
	std::vector<double> x(7);
	poseToBlock(T, x.data());
	return x;
}

inline std::vector<double> block(const Eigen::VectorXd& v)
{
	return {v.data(), v.data() + v.size()};
}

inline Eigen::VectorXd residualAt(const LocalCost& cost, const Blocks& x)
{
	Eigen::VectorXd r(cost.num_residuals());
	EXPECT_TRUE(cost.evaluateLocal(pointers(x).data(), r.data(), nullptr));
	return r;
}

/** The local Jacobian of each block; of linearize(), thus at the frozen points where there are any. */
inline std::vector<RowMajor> localJacobians(const LocalCost& cost, const Blocks& x)
{
	std::vector<RowMajor> J;
	std::vector<double*> p;
	for (const BlockShape& shape : cost.shapes()) J.push_back(RowMajor::Constant(cost.num_residuals(), shape.tangent, 1e300));
	for (auto& j : J) p.push_back(j.data());
	Eigen::VectorXd r(cost.num_residuals());
	EXPECT_TRUE(cost.linearize(pointers(x).data(), r.data(), p.data()));
	return J;
}

/** Five-point differences: truncation ~ h^4, rounding ~ 1e-16 / h. */
inline RowMajor numericJacobian(const LocalCost& cost, const Blocks& x, size_t index, double h = 1e-4)
{
	const BlockShape shape = cost.shapes()[index];
	RowMajor J(cost.num_residuals(), shape.tangent);
	for (int column = 0; column < shape.tangent; ++column)
	{
		const auto at = [&](double step)
		{
			Blocks moved = x;
			Eigen::VectorXd delta = Eigen::VectorXd::Zero(shape.tangent);
			delta[column] = step;
			blockPlus(shape, x[index].data(), delta.data(), moved[index].data());
			return residualAt(cost, moved);
		};
		J.col(column) = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
	}
	return J;
}

/** Worst relative error over the whole Jacobian and over the Jacobian of each block (blocks that are all but zero: relative to the whole).
 *  @param unwhiten applied to the rows from the left, so that rows of large weight do not hide the others. */
inline double jacobianError(const LocalCost& cost, const Blocks& x, const Eigen::MatrixXd& unwhiten = {})
{
	const std::vector<RowMajor> analytic = localJacobians(cost, x);
	double whole2 = 0, error2 = 0;
	std::vector<double> norms, errors;
	for (size_t i = 0; i < analytic.size(); ++i)
	{
		RowMajor numeric = numericJacobian(cost, x, i);
		RowMajor difference = analytic[i] - numeric;
		if (unwhiten.size() > 0) numeric = unwhiten * numeric, difference = unwhiten * difference;
		norms.push_back(numeric.norm());
		errors.push_back(difference.norm());
		whole2 += numeric.squaredNorm();
		error2 += difference.squaredNorm();
	}
	double worst = std::sqrt(error2 / whole2);
	for (size_t i = 0; i < norms.size(); ++i) worst = std::max(worst, errors[i] / std::max(norms[i], 1e-4 * std::sqrt(whole2)));
	return worst;
}

/** Relative error of Evaluate()'s ambient Jacobians, brought down by PoseManifold, as Ceres' own checker sees them. */
inline double liftingError(const LocalCost& cost, const Blocks& x)
{
	PoseManifold pose;
	std::vector<const ceres::Manifold*> manifolds;
	for (const BlockShape& shape : cost.shapes()) manifolds.push_back(shape.kind == BlockKind::pose ? &pose : nullptr);
	ceres::NumericDiffOptions options;
	options.ridders_relative_initial_step_size = 1e-3;
	ceres::GradientChecker checker(&cost, &manifolds, options);
	ceres::GradientChecker::ProbeResults results;
	checker.Probe(pointers(x).data(), 1e-6, &results);
	double norm2 = 0, error2 = 0;
	for (size_t i = 0; i < results.local_jacobians.size(); ++i)
	{
		norm2 += results.local_numeric_jacobians[i].squaredNorm();
		error2 += (results.local_jacobians[i] - results.local_numeric_jacobians[i]).squaredNorm();
	}
	return std::sqrt(error2 / norm2);
}

/** Asserts both errors < 1e-6 and prints the worst. */
inline void expectJacobians(const std::string& name, const LocalCost& cost, const std::vector<Blocks>& states,
                            const Eigen::MatrixXd& unwhiten = {})
{
	double jacobian = 0, lifting = 0;
	for (const Blocks& x : states)
	{
		jacobian = std::max(jacobian, jacobianError(cost, x, unwhiten));
		lifting = std::max(lifting, liftingError(cost, x));
	}
	std::cout << "[measured] " << name << ": Jacobian relative error " << jacobian << ", lifted " << lifting << ", " << states.size()
	          << " states\n";
	EXPECT_LT(jacobian, 1e-6) << name;
	EXPECT_LT(lifting, 1e-6) << name;
}

/** One seeded source of random vectors, poses and states. */
class Random
{
   public:
	explicit Random(unsigned seed) : engine_(seed) {}
	double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
	double normal() { return normal_(engine_); }
	Eigen::VectorXd vector(int n, double scale)
	{
		Eigen::VectorXd v(n);
		for (int i = 0; i < n; ++i) v[i] = scale * normal();
		return v;
	}
	Eigen::Vector3d vector3(double scale) { return vector(3, scale); }
	Pose3 pose(double angle, double distance) { return {so3::expQuaternion(vector3(angle)), vector3(distance)}; }

   private:
	std::mt19937_64 engine_;
	std::normal_distribution<double> normal_;
};

/** States at identity (zero), near it (1e-8) and at random, for the given shapes. */
inline std::vector<Blocks> sampleStates(const std::vector<BlockShape>& shapes, Random& random, int count = 10)
{
	std::vector<Blocks> states;
	for (int i = 0; i < count; ++i)
	{
		const double scale = i == 0 ? 0 : (i == 1 ? 1e-8 : 1);
		Blocks x;
		for (const BlockShape& shape : shapes)
			x.push_back(shape.kind == BlockKind::pose ? block(random.pose(0.8 * scale, 3 * scale))
			                                          : block(random.vector(shape.tangent, 0.5 * scale)));
		states.push_back(x);
	}
	return states;
}
}  // namespace viwo::test
