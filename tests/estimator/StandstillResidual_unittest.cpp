#include <residuals/StandstillResidual.h>

#include <NumericJacobian.h>

namespace viwo
{
TEST(StandstillResidual, VelocityInSigmas)
{
	test::Random random(51);
	const StandstillResidual cost(0.01);
	const std::vector<double> standing{0, 0, 0, 0.1, 0.2, 0.3, 0.001, 0.002, 0.003}, moving{0.01, 0, -0.02, 0, 0, 0, 0, 0.002, 0.003};
	EXPECT_EQ(test::residualAt(cost, {standing}).norm(), 0);
	EXPECT_LT((test::residualAt(cost, {moving}) - Eigen::Vector3d(1, 0, -2)).norm(), 1e-12);
	test::expectJacobians("StandstillResidual", cost, test::sampleStates(cost.shapes(), random));
}
}  // namespace viwo
