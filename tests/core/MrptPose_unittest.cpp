#include <gtest/gtest.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/So3.h>

#include <random>

using namespace viwo;

TEST(MrptPose, RoundTripAndComposition)
{
	std::mt19937 generator(3);
	std::uniform_real_distribution<double> uniform(-3, 3);
	const auto randomPose = [&]
	{
		const Eigen::Vector3d phi(uniform(generator), uniform(generator), uniform(generator));
		return Pose3(so3::expQuaternion(phi), Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator)));
	};
	for (int i = 0; i < 50; i++)
	{
		const Pose3 a = randomPose(), b = randomPose();
		EXPECT_LT((fromMrpt(toMrpt(a)).p - a.p).norm(), 1e-15);
		EXPECT_LT(fromMrpt(toMrpt(a)).R.angularDistance(a.R), 1e-14);
		const Pose3 product = fromMrpt(toMrpt(a) + toMrpt(b));
		EXPECT_LT((product.p - (a * b).p).norm(), 1e-13);
		EXPECT_LT(product.R.angularDistance((a * b).R), 1e-13);
		EXPECT_LT((fromMrpt(-toMrpt(a)).p - a.inverse().p).norm(), 1e-13);
	}
}

TEST(MrptPose, ForwardCamera)
{
	const double degree = M_PI / 180;
	const mrpt::poses::CPose3D forward(0.1, 0.2, 0.3, -90 * degree, 0, -90 * degree);
	EXPECT_LT(fromMrpt(forward).R.angularDistance(forwardOpticalAxes()), 1e-12);
	EXPECT_LT((forwardOpticalAxes() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-15);
	EXPECT_NEAR(yawOf(fromMrpt(mrpt::poses::CPose3D(0, 0, 0, 0.7, 0.2, -0.1)).R), 0.7, 1e-14);
}
