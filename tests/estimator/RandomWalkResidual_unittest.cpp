#include <residuals/RandomWalkResidual.h>

#include <NumericJacobian.h>

namespace viwo
{
TEST(RandomWalkResidual, DriftInSigmasAndJacobians)
{
	test::Random random(41);
	const RandomWalkResidual cost(Eigen::Vector3d(0.1, 0.2, 0.5));
	EXPECT_LT((test::residualAt(cost, {{1, 1, 1}, {2, 2, 2}}) - Eigen::Vector3d(10, 5, 2)).norm(), 1e-12);
	test::expectJacobians("RandomWalkResidual", cost, test::sampleStates(cost.shapes(), random));
}
}  // namespace viwo
