#include <residuals/ReprojectionResidual.h>

#include <NumericJacobian.h>

namespace viwo
{
namespace
{
constexpr double sigma = 1.0 / 460;

struct Scene
{
	Pose3 T_i, T_j, T_BC;
	Eigen::Vector3d b_i, b_j;
	double lambda = 0;

	test::Blocks blocks() const { return {test::block(T_i), test::block(T_j), test::block(T_BC), {lambda}}; }
};

/** A landmark 1 to 6 m before camera i, and its exact bearing in j. */
Scene makeScene(test::Random& random, double scale)
{
	Scene s;
	s.T_i = random.pose(0.8 * scale, scale);
	s.T_j = s.T_i * random.pose(0.15 * scale, 0.2 * scale);
	s.T_BC = random.pose(0.8 * scale, 0.3 * scale);
	s.b_i = Eigen::Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1).normalized();
	s.lambda = 1 / random.uniform(1, 6);
	const Eigen::Vector3d x_W = s.T_i * (s.T_BC * (s.b_i / s.lambda));
	s.b_j = (s.T_BC.inverse() * (s.T_j.inverse() * x_W)).normalized();
	return s;
}
}  // namespace

TEST(ReprojectionResidual, VanishesAtTheTruth)
{
	test::Random random(11);
	double worst = 0;
	for (int i = 0; i < 100; ++i)
	{
		const Scene s = makeScene(random, 1);
		worst = std::max(worst, test::residualAt(ReprojectionResidual(s.b_i, s.b_j, sigma), s.blocks()).norm());
	}
	std::cout << "[measured] ReprojectionResidual at the truth: " << worst << " sigma\n";
	EXPECT_LT(worst, 1e-11);
}

TEST(ReprojectionResidual, IsTheAngleInSigmasForSmallErrors)
{
	test::Random random(12);
	const Scene s = makeScene(random, 1);
	const Eigen::Vector3d axis = s.b_j.cross(random.vector3(1)).normalized();
	const Eigen::Vector3d turned = so3::exp(1e-3 * axis) * s.b_j;
	EXPECT_NEAR(test::residualAt(ReprojectionResidual(s.b_i, turned, sigma), s.blocks()).norm(), std::sin(1e-3) / sigma, 1e-9);
}

TEST(ReprojectionResidual, Jacobians)
{
	test::Random random(13);
	for (const double scale : {0.0, 1e-8, 1.0, 1.0, 1.0, 1.0})
	{
		const Scene s = makeScene(random, scale);
		const Eigen::Vector3d seen = so3::exp(random.vector3(0.05)) * s.b_j;
		test::expectJacobians("ReprojectionResidual", ReprojectionResidual(s.b_i, seen, sigma), {s.blocks()});
	}
}

TEST(ReprojectionResidual, RejectsLandmarksBehindTheCamera)
{
	test::Random random(14);
	Scene s = makeScene(random, 1);
	const ReprojectionResidual cost(s.b_i, s.b_j, sigma), antipode(s.b_i, -s.b_j, sigma);
	const auto valid = [&](const ReprojectionResidual& c)
	{
		const test::Blocks x = s.blocks();
		return c.valid(x[0].data(), x[1].data(), x[2].data(), x[3].data());
	};
	EXPECT_TRUE(valid(cost));
	EXPECT_FALSE(valid(antipode));
	s.lambda = 0;
	EXPECT_FALSE(valid(cost));
	s.lambda = -0.2;
	EXPECT_FALSE(valid(cost));
}

TEST(ReprojectionResidual, TangentBasisIsOrthonormalAndDoesNotJump)
{
	test::Random random(15);
	for (int i = 0; i < 100; ++i)
	{
		const Eigen::Vector3d b = random.vector3(1).normalized();
		Eigen::Matrix3d frame;
		frame << ReprojectionResidual::tangentBasis(b), b;
		EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-14);
		const Eigen::Vector3d near = (b + random.vector3(1e-6)).normalized();
		if (std::abs(b.z()) < 1e-3) continue;
		EXPECT_LT((ReprojectionResidual::tangentBasis(near) - ReprojectionResidual::tangentBasis(b)).norm(), 1e-4);
	}
}
}  // namespace viwo
