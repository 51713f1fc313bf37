#include <residuals/LinearPrior.h>

#include <NumericJacobian.h>

namespace viwo
{
namespace
{
const std::vector<BlockShape> shapes{BlockShape::pose(), BlockShape::euclidean(9), BlockShape::euclidean(1), BlockShape::pose()};

LinearPrior makePrior(test::Random& random, const test::Blocks& x0)
{
	const Eigen::MatrixXd J0 = Eigen::MatrixXd::NullaryExpr(20, 22, [&] { return random.normal(); });
	return {shapes, x0, J0, random.vector(20, 1)};
}
}  // namespace

TEST(LinearPrior, JacobiansAtTheLinearizationPoint)
{
	test::Random random(81);
	for (const test::Blocks& x0 : test::sampleStates(shapes, random, 4)) test::expectJacobians("LinearPrior", makePrior(random, x0), {x0});
}

TEST(LinearPrior, JacobianStaysAndResidualIsLinearInTheDeviation)
{
	test::Random random(82);
	const auto states = test::sampleStates(shapes, random, 4);
	const test::Blocks &x0 = states[2], &x = states[3];
	const LinearPrior prior = makePrior(random, x0);
	const auto J_x0 = test::localJacobians(prior, x0), J_x = test::localJacobians(prior, x);
	Eigen::VectorXd expected = test::residualAt(prior, x0);
	for (size_t i = 0; i < shapes.size(); ++i)
	{
		EXPECT_EQ(J_x0[i], J_x[i]);
		Eigen::VectorXd delta(shapes[i].tangent);
		blockMinus(shapes[i], x[i].data(), x0[i].data(), delta.data());
		expected += J_x0[i] * delta;
		EXPECT_EQ(std::vector<double>(prior.linearizationPoint(int(i)), prior.linearizationPoint(int(i)) + shapes[i].ambient), x0[i]);
	}
	EXPECT_LT((test::residualAt(prior, x) - expected).norm(), 1e-12 * expected.norm());
}
}  // namespace viwo
