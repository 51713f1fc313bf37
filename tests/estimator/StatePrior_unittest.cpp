#include <residuals/StatePrior.h>

#include <NumericJacobian.h>

#include <limits>

namespace viwo
{
TEST(StatePrior, Jacobians)
{
	test::Random random(31);
	Eigen::VectorXd sigmas(6);
	sigmas << 0.1, 0.2, 0.3, 0.04, 0.05, 0.06;
	const auto x0 = test::block(random.pose(0.5, 2));
	test::expectJacobians("StatePrior, pose", StatePrior(BlockShape::pose(), x0.data(), sigmas),
	                      test::sampleStates({BlockShape::pose()}, random));
	sigmas[1] = sigmas[5] = std::numeric_limits<double>::infinity();
	test::expectJacobians("StatePrior, rows dropped", StatePrior(BlockShape::pose(), x0.data(), sigmas),
	                      test::sampleStates({BlockShape::pose()}, random));
	const auto v0 = test::block(random.vector(9, 1));
	test::expectJacobians("StatePrior, motion", StatePrior(BlockShape::euclidean(9), v0.data(), Eigen::VectorXd::Constant(9, 0.3)),
	                      test::sampleStates({BlockShape::euclidean(9)}, random));
}

TEST(StatePrior, CovarianceWhitens)
{
	test::Random random(33);
	const std::vector<double> x0 = test::block(random.pose(0.8, 2));
	Eigen::MatrixXd root(6, 6);
	for (int i = 0; i < 6; ++i) root.col(i) = random.vector(6, 0.3);
	const Eigen::MatrixXd covariance = root * root.transpose() + 1e-2 * Eigen::MatrixXd::Identity(6, 6);
	const auto cost = StatePrior::fromCovariance(BlockShape::pose(), x0.data(), covariance);
	const Eigen::VectorXd delta = random.vector(6, 0.2);
	std::vector<double> x = x0;
	blockPlus(BlockShape::pose(), x0.data(), delta.data(), x.data());
	EXPECT_NEAR(test::residualAt(*cost, {x}).squaredNorm(), delta.dot(covariance.inverse() * delta), 1e-9);
	test::expectJacobians("StatePrior, full covariance", *cost, test::sampleStates({BlockShape::pose()}, random));
}

TEST(StatePrior, InfiniteSigmasDropTheirRows)
{
	const Eigen::Vector3d x0(1, 2, 3), sigmas(0.5, std::numeric_limits<double>::infinity(), 0.1);
	const StatePrior cost(BlockShape::euclidean(3), x0.data(), sigmas);
	ASSERT_EQ(cost.num_residuals(), 2);
	EXPECT_LT((test::residualAt(cost, {{2, 7, 4}}) - Eigen::Vector2d(2, 10)).norm(), 1e-12);
}
}  // namespace viwo
