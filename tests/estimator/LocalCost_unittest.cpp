#include <residuals/LocalCost.h>

#include <residuals/StatePrior.h>

#include <NumericJacobian.h>

namespace viwo
{
namespace
{
/** r = s: defined for s > 0 only. */
class HalfLine : public LocalCost
{
   public:
	HalfLine() : LocalCost(1, {BlockShape::euclidean(1)}) {}
	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override
	{
		residuals[0] = x[0][0];
		if (jacobians && jacobians[0]) jacobians[0][0] = 1;
		return x[0][0] > 0;
	}
};

StatePrior makePrior(const Pose3& T)
{
	return {BlockShape::pose(), test::block(T).data(), Eigen::VectorXd::Constant(6, 0.1)};
}
}  // namespace

TEST(LocalCost, FrozenJacobianIsThatOfTheFrozenPointAndTheResidualFollowsTheState)
{
	test::Random random(1);
	StatePrior cost = makePrior(random.pose(0.5, 1));
	const test::Blocks x0{test::block(random.pose(0.5, 1))}, x{test::block(random.pose(0.5, 1))};
	const auto J_x0 = test::localJacobians(cost, x0)[0];
	const auto J_x = test::localJacobians(cost, x)[0];
	ASSERT_GT((J_x0 - J_x).norm(), 1e-2);

	cost.freeze(0, x0[0].data());
	EXPECT_EQ(test::localJacobians(cost, x)[0], J_x0);
	Eigen::VectorXd r(6);
	test::RowMajor J(6, 6);
	double* p[] = {J.data()};
	ASSERT_TRUE(cost.linearize(test::pointers(x).data(), r.data(), p));
	EXPECT_EQ(r, test::residualAt(cost, x));
	EXPECT_EQ(std::vector<double>(cost.linearizationPoint(0), cost.linearizationPoint(0) + 7), x0[0]);

	cost.freeze(0, nullptr);
	EXPECT_EQ(cost.linearizationPoint(0), nullptr);
	EXPECT_EQ(test::localJacobians(cost, x)[0], J_x);
}

TEST(LocalCost, LiftedFrozenJacobianComesBackThroughThePlusJacobian)
{
	test::Random random(2);
	StatePrior cost = makePrior(random.pose(0.5, 1));
	const test::Blocks x0{test::block(random.pose(0.5, 1))}, x{test::block(random.pose(0.5, 1))};
	cost.freeze(0, x0[0].data());
	test::RowMajor ambient(6, 7), plus(7, 6);
	Eigen::VectorXd r(6);
	double* p[] = {ambient.data()};
	ASSERT_TRUE(cost.Evaluate(test::pointers(x).data(), r.data(), p));
	PoseManifold().PlusJacobian(x[0].data(), plus.data());
	EXPECT_LT((ambient * plus - test::localJacobians(cost, x0)[0]).norm(), 1e-13 * ambient.norm());
}

TEST(LocalCost, UndefinedResidualIsLargeAndFlat)
{
	HalfLine cost;
	const double s = -1;
	const double* x[] = {&s};
	double r = 0, j = 7;
	double* J[] = {&j};
	EXPECT_TRUE(cost.Evaluate(x, &r, J));
	EXPECT_EQ(r, LocalCost::kInvalidResidual);
	EXPECT_EQ(j, 0);
	EXPECT_FALSE(cost.linearize(x, &r, J));
}
}  // namespace viwo
