#include <residuals/GaugePrior.h>

#include <NumericJacobian.h>

namespace viwo
{
TEST(GaugePrior, Jacobians)
{
	test::Random random(21);
	test::expectJacobians("GaugePrior at identity", GaugePrior(Pose3(), Eigen::Vector3d(-0.2, 0.1, -0.3), 1e-2, 1e-2),
	                      test::sampleStates({BlockShape::pose()}, random));
	test::expectJacobians("GaugePrior", GaugePrior(random.pose(0.8, 2), random.vector3(0.3), 1e-2, 1e-2),
	                      test::sampleStates({BlockShape::pose()}, random));
}

TEST(GaugePrior, MeasuresPositionAndYawAboutTheWorldsUp)
{
	test::Random random(22);
	const Pose3 T0 = random.pose(0.8, 2);
	const Eigen::Vector3d p_BO = random.vector3(0.3);
	const Pose3 turned = Pose3(so3::expQuaternion(Eigen::Vector3d(0, 0, 0.3)), Eigen::Vector3d::Zero()) * T0;
	const Pose3 moved(turned.R, T0 * p_BO + Eigen::Vector3d(1, 2, 3) - turned.R * p_BO);
	const Eigen::VectorXd r = test::residualAt(GaugePrior(T0, p_BO, 0.1, 0.01), {test::block(moved)});
	EXPECT_LT((r - Eigen::Vector4d(10, 20, 30, 30)).norm(), 1e-10);
}

TEST(GaugePrior, LeavesRollAndPitchAboutTheVehicleFree)
{
	test::Random random(23);
	const Pose3 T0 = random.pose(0.8, 2);
	const Eigen::Vector3d p_BO = random.vector3(0.3);
	const Eigen::Quaterniond R = so3::expQuaternion(Eigen::Vector3d(0.2, -0.1, 0)) * T0.R;
	EXPECT_LT(test::residualAt(GaugePrior(T0, p_BO, 1e-4, 1e-5), {test::block(Pose3(R, T0 * p_BO - R * p_BO))}).norm(), 1e-9);
}
}  // namespace viwo
