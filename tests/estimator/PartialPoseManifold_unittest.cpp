#include <residuals/PartialPoseManifold.h>

#include <NumericJacobian.h>

namespace viwo
{
TEST(PartialPoseManifold, HoldsWhatIsNotFree)
{
	test::Random random(7);
	const Pose3 T = random.pose(0.8, 2);
	const std::vector<double> x = test::block(T);
	const PartialPoseManifold yaw_and_place({true, true, true, false, false, true});
	ASSERT_EQ(yaw_and_place.TangentSize(), 4);
	const Eigen::Vector4d delta(0.1, -0.2, 0.3, 0.4);
	std::vector<double> y(7);
	yaw_and_place.Plus(x.data(), delta.data(), y.data());
	const Vector6d moved = poseMinus(poseFromBlock(y.data()), T);
	EXPECT_LT((moved - (Vector6d() << 0.1, -0.2, 0.3, 0, 0, 0.4).finished()).norm(), 1e-12);
	Eigen::Vector4d back;
	yaw_and_place.Minus(y.data(), x.data(), back.data());
	EXPECT_LT((back - delta).norm(), 1e-12);
}

TEST(PartialPoseManifold, JacobiansAreThoseOfPlusAndMinus)
{
	test::Random random(8);
	const std::vector<double> x = test::block(random.pose(0.8, 2));
	const PartialPoseManifold manifold({false, true, true, false, true, true});
	Eigen::Matrix<double, 7, 4, Eigen::RowMajor> plus;
	Eigen::Matrix<double, 4, 7, Eigen::RowMajor> minus;
	manifold.PlusJacobian(x.data(), plus.data());
	manifold.MinusJacobian(x.data(), minus.data());
	EXPECT_LT((minus * plus - Eigen::Matrix4d::Identity()).norm(), 1e-12);
	constexpr double h = 1e-6;
	for (int i = 0; i < 4; ++i)
	{
		const Eigen::Vector4d delta = h * Eigen::Vector4d::Unit(i);
		Eigen::Matrix<double, 7, 1> y;
		manifold.Plus(x.data(), delta.data(), y.data());
		const Eigen::Matrix<double, 7, 1> slope = (y - Eigen::Map<const Eigen::Matrix<double, 7, 1>>(x.data())) / h;
		EXPECT_LT((slope - plus.col(i)).norm(), 1e-5);
	}
}
}  // namespace viwo
