#include <residuals/PairPlaneResidual.h>

#include <NumericJacobian.h>

namespace viwo
{
TEST(PairPlaneResidual, Jacobians)
{
	test::Random random(71);
	const std::vector<BlockShape> shapes{BlockShape::pose(), BlockShape::pose()};
	test::expectJacobians("PairPlaneResidual, no lever arm", PairPlaneResidual(Pose3(), 0.01, 0.02), test::sampleStates(shapes, random));
	test::expectJacobians("PairPlaneResidual", PairPlaneResidual(random.pose(0.8, 0.5), 0.01, 0.02), test::sampleStates(shapes, random));
}

TEST(PairPlaneResidual, VanishesForPlanarMotionOfTheVehicle)
{
	test::Random random(72);
	const Pose3 T_BO = random.pose(0.8, 0.5), T_WOi = random.pose(0.8, 2);
	const Pose3 T_OiOj(so3::expQuaternion(Eigen::Vector3d(0, 0, 0.7)), Eigen::Vector3d(1, -2, 0));
	const PairPlaneResidual cost(T_BO, 0.01, 0.02);
	const auto block_i = test::block(T_WOi * T_BO.inverse());
	EXPECT_LT(test::residualAt(cost, {block_i, test::block(T_WOi * T_OiOj * T_BO.inverse())}).norm(), 1e-12);
	const Pose3 lifted(T_OiOj.R, T_OiOj.p + Eigen::Vector3d(0, 0, 0.04));
	EXPECT_LT((test::residualAt(cost, {block_i, test::block(T_WOi * lifted * T_BO.inverse())}) - Eigen::Vector3d(0, 0, 2)).norm(), 1e-12);
}
}  // namespace viwo
