#include <residuals/GaugePrior.h>

#include <NumericJacobian.h>

namespace viwo
{
TEST(GaugePrior, Jacobians)
{
	test::Random random(21);
	test::expectJacobians("GaugePrior at identity", GaugePrior(Pose3(), 1e-2, 1e-2), test::sampleStates({BlockShape::pose()}, random));
	test::expectJacobians("GaugePrior", GaugePrior(random.pose(0.8, 2), 1e-2, 1e-2), test::sampleStates({BlockShape::pose()}, random));
}

TEST(GaugePrior, MeasuresPositionAndYawAboutTheWorldsUp)
{
	test::Random random(22);
	const Pose3 T0 = random.pose(0.8, 2);
	const Pose3 turned = Pose3(so3::expQuaternion(Eigen::Vector3d(0, 0, 0.3)), Eigen::Vector3d::Zero()) * T0;
	const Pose3 moved(turned.R, T0.p + Eigen::Vector3d(1, 2, 3));
	const Eigen::VectorXd r = test::residualAt(GaugePrior(T0, 0.1, 0.01), {test::block(moved)});
	EXPECT_LT((r - Eigen::Vector4d(10, 20, 30, 30)).norm(), 1e-10);
}

TEST(GaugePrior, LeavesRollAndPitchFree)
{
	test::Random random(23);
	const Pose3 T0 = random.pose(0.8, 2);
	const Pose3 tilted = Pose3(so3::expQuaternion(Eigen::Vector3d(0.2, -0.1, 0)), Eigen::Vector3d::Zero()) * T0;
	EXPECT_LT(test::residualAt(GaugePrior(T0, 1e-4, 1e-5), {test::block(Pose3(tilted.R, T0.p))}).norm(), 1e-9);
}
}  // namespace viwo
