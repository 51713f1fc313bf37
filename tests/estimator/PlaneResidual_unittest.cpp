#include <residuals/PlaneResidual.h>

#include <NumericJacobian.h>

namespace viwo
{
TEST(PlaneResidual, Jacobians)
{
	test::Random random(61);
	const std::vector<BlockShape> shapes{BlockShape::pose(), BlockShape::euclidean(3)};
	test::expectJacobians("PlaneResidual, no lever arm", PlaneResidual(Pose3(), 0.01, 0.02), test::sampleStates(shapes, random));
	test::expectJacobians("PlaneResidual", PlaneResidual(random.pose(0.8, 0.5), 0.01, 0.02), test::sampleStates(shapes, random));
}

TEST(PlaneResidual, JacobiansWithMounting)
{
	test::Random random(63);
	const PlaneResidual cost(0.01, 0.02);
	test::expectJacobians("PlaneResidual with T_BO", cost, test::sampleStates(cost.shapes(), random));
	const Pose3 T_BO = random.pose(0.8, 0.5), T_WB = random.pose(0.8, 2);
	const Eigen::Vector3d plane(0.1, -0.2, 0.3);
	const Eigen::VectorXd given = test::residualAt(PlaneResidual(T_BO, 0.01, 0.02), {test::block(T_WB), test::block(plane)});
	EXPECT_EQ((test::residualAt(cost, {test::block(T_WB), test::block(plane), test::block(T_BO)}) - given).norm(), 0);
}

TEST(PlaneResidual, VanishesWhereverTheVehicleStandsOnAnInclinedPlane)
{
	test::Random random(62);
	const Pose3 T_BO = random.pose(0.8, 0.5);
	const Eigen::Vector3d plane(0.05, -0.08, 0.7);
	const Pose3 T_WP(so3::expQuaternion(Eigen::Vector3d(plane.x(), plane.y(), 0)), Eigen::Vector3d::Zero());
	double worst = 0;
	for (int i = 0; i < 20; ++i)
	{
		const Pose3 T_PO(so3::expQuaternion(Eigen::Vector3d(0, 0, random.uniform(-3, 3))),
		                 Eigen::Vector3d(random.normal(), random.normal(), plane.z()));
		const Pose3 T_WB = T_WP * T_PO * T_BO.inverse();
		worst = std::max(worst, test::residualAt(PlaneResidual(T_BO, 0.01, 0.02), {test::block(T_WB), test::block(plane)}).norm());
	}
	std::cout << "[measured] PlaneResidual on the plane: " << worst << " sigma\n";
	EXPECT_LT(worst, 1e-12);
}

TEST(PlaneResidual, SignsAndUnits)
{
	const Pose3 T_WO(so3::expQuaternion(Eigen::Vector3d(0.01, 0.02, 0)), Eigen::Vector3d(5, 6, 0.1));
	const Eigen::VectorXd r = test::residualAt(PlaneResidual(Pose3(), 0.01, 0.02), {test::block(T_WO), {0, 0, 0}});
	EXPECT_LT((r - Eigen::Vector3d(-2, 1, 5)).norm(), 1e-3);
}
}  // namespace viwo
