#include <residuals/PoseManifold.h>

#include <NumericJacobian.h>

namespace viwo
{
namespace
{
using Matrix76 = Eigen::Matrix<double, 7, 6, Eigen::RowMajor>;
using Matrix67 = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;
}  // namespace

TEST(PoseManifold, MinusUndoesPlusAndPlusUndoesMinus)
{
	const PoseManifold manifold;
	test::Random random(3);
	double worst = 0;
	for (const double scale : {0.0, 1e-8, 0.1, 0.9})
	{
		const auto x = test::block(random.pose(1, 5)), y = test::block(random.pose(1, 5));
		const Vector6d delta = random.vector(6, scale);
		std::vector<double> moved(7), back(7);
		Vector6d found, difference;
		manifold.Plus(x.data(), delta.data(), moved.data());
		manifold.Minus(moved.data(), x.data(), found.data());
		worst = std::max(worst, (found - delta).norm());
		manifold.Minus(y.data(), x.data(), difference.data());
		manifold.Plus(x.data(), difference.data(), back.data());
		manifold.Minus(back.data(), y.data(), found.data());
		worst = std::max(worst, found.norm());
	}
	std::cout << "[measured] PoseManifold: plus and minus disagree by " << worst << "\n";
	EXPECT_LT(worst, 1e-14);
}

TEST(PoseManifold, PerturbsTheRotationOnTheRight)
{
	test::Random random(4);
	const Pose3 T = random.pose(1, 5);
	const Vector6d delta = random.vector(6, 0.3);
	std::vector<double> moved(7);
	PoseManifold().Plus(test::block(T).data(), delta.data(), moved.data());
	const Pose3 T_moved = poseFromBlock(moved.data());
	EXPECT_LT((T_moved.R.toRotationMatrix() - T.R.toRotationMatrix() * so3::exp(delta.tail<3>())).norm(), 1e-14);
	EXPECT_LT((T_moved.p - T.p - delta.head<3>()).norm(), 1e-14);
}

TEST(PoseManifold, JacobiansAreTheDerivativesAndInverseToEachOther)
{
	const PoseManifold manifold;
	test::Random random(5);
	double worst = 0, product = 0;
	for (const double scale : {0.0, 1e-8, 0.8, 0.8, 0.8})
	{
		const auto x = test::block(random.pose(scale, 5 * scale));
		Matrix76 plus, numeric;
		Matrix67 minus;
		manifold.PlusJacobian(x.data(), plus.data());
		manifold.MinusJacobian(x.data(), minus.data());
		const double h = 1e-5;
		for (int i = 0; i < 6; ++i)
		{
			Eigen::Matrix<double, 7, 1> a, b;
			const Vector6d step = h * Vector6d::Unit(i), back = -step;
			manifold.Plus(x.data(), step.data(), a.data());
			manifold.Plus(x.data(), back.data(), b.data());
			numeric.col(i) = (a - b) / (2 * h);
		}
		worst = std::max(worst, (plus - numeric).norm() / numeric.norm());
		product = std::max(product, (minus * plus - Eigen::Matrix<double, 6, 6>::Identity()).norm());
	}
	std::cout << "[measured] PoseManifold: plus Jacobian " << worst << ", minus * plus - I " << product << "\n";
	EXPECT_LT(worst, 1e-9);
	EXPECT_LT(product, 1e-14);
}
}  // namespace viwo
