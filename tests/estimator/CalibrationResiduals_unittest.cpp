#include <gtest/gtest.h>

#include "ImuPreintegration.h"
#include "NumericJacobian.h"
#include "residuals/ExtendedResidual.h"
#include "residuals/PlaneResidual.h"
#include "residuals/ReferenceResidual.h"

namespace viwo
{
namespace
{
using test::block;
using test::Blocks;
using test::Random;

Pose3 randomPose(Random& random)
{
	return {so3::expQuaternion(random.vector(3, 0.8)), Eigen::Vector3d(random.vector(3, 1))};
}

TEST(ReferenceResidual, Jacobians)
{
	Random random(3);
	std::vector<Blocks> states;
	const Pose3 T_RO = randomPose(random);
	const ReferenceResidual cost(T_RO, random.vector(3, 0.4), random.vector(3, 0.6), random.vector(6, 1).cwiseAbs() * 20);
	for (int i = 0; i < 5; ++i)
		states.push_back({block(randomPose(random)), block(randomPose(random)), block(randomPose(random)), {0.02 * i}});
	test::expectJacobians("reference", cost, states);
}

TEST(ReferenceResidual, VanishesAtTheTruth)
{
	Random random(4);
	const Pose3 T_WB = randomPose(random), T_BO = randomPose(random), T_RW = randomPose(random);
	const Eigen::Vector3d v_O(0.3, 0.1, 0), w_O(0, 0.1, 0.5);
	const ReferenceResidual cost(T_RW * T_WB * T_BO, v_O, w_O, Eigen::Matrix<double, 6, 1>::Constant(100));
	EXPECT_LT(test::residualAt(cost, {block(T_WB), block(T_BO), block(T_RW), {0}}).norm(), 1e-9);
	// The robot 10 ms later, a reference whose clock is 10 ms late.
	constexpr double kLate_s = 0.01;
	const Pose3 step(so3::expQuaternion(w_O * kLate_s), v_O * kLate_s);
	const Pose3 T_WB_late = T_WB * T_BO * step * T_BO.inverse();
	EXPECT_LT(test::residualAt(cost, {block(T_WB_late), block(T_BO), block(T_RW), {kLate_s}}).norm(), 1e-2);
}

TEST(ExtendedResidual, AddsALinearBlock)
{
	Random random(5);
	const auto base = std::make_shared<PlaneResidual>(randomPose(random), 0.01, 0.02);
	Eigen::MatrixXd J(3, 4);
	for (int i = 0; i < 4; ++i) J.col(i) = random.vector(3, 30);
	const Eigen::VectorXd theta_0 = random.vector(4, 0.1);
	const ExtendedResidual cost(base, J, theta_0);
	std::vector<Blocks> states;
	for (int i = 0; i < 4; ++i) states.push_back({block(randomPose(random)), block(random.vector(3, 0.1)), block(random.vector(4, 0.1))});
	test::expectJacobians("extended", cost, states);
	Blocks at = states.front();
	at[2] = block(theta_0);
	EXPECT_LT((test::residualAt(cost, at) - test::residualAt(*base, {at[0], at[1]})).norm(), 1e-12);
}
}  // namespace
}  // namespace viwo
