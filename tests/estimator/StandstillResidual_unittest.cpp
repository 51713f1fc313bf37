#include <residuals/StandstillResidual.h>

#include <NumericJacobian.h>

namespace viwo
{
TEST(StandstillResidual, VelocityAndGyroBias)
{
	test::Random random(51);
	const StandstillResidual velocity(0.01), both(0.01, Eigen::Vector3d(0.001, 0.002, 0.003), 1e-3);
	const std::vector<double> standing{0, 0, 0, 0.1, 0.2, 0.3, 0.001, 0.002, 0.003}, moving{0.01, 0, 0, 0, 0, 0, 0, 0.002, 0.003};
	EXPECT_EQ(velocity.num_residuals(), 3);
	EXPECT_EQ(test::residualAt(both, {standing}).norm(), 0);
	Eigen::VectorXd expected(6);
	expected << 1, 0, 0, 1, 0, 0;
	EXPECT_LT((test::residualAt(both, {moving}) - expected).norm(), 1e-12);
	test::expectJacobians("StandstillResidual, velocity", velocity, test::sampleStates(velocity.shapes(), random));
	test::expectJacobians("StandstillResidual, velocity and gyro", both, test::sampleStates(both.shapes(), random));
}
}  // namespace viwo
