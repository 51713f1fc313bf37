#include <residuals/ImuResidual.h>

#include <ConstantTwist.h>
#include <NumericJacobian.h>

namespace viwo
{
namespace
{
test::ConstantTwist makeMotion(test::Random& random)
{
	test::ConstantTwist motion;
	motion.T_WO0 = {so3::expQuaternion(Eigen::Vector3d(0, 0, 0.7)), Eigen::Vector3d(1, -2, 0.3)};
	motion.T_BO = random.pose(0.8, 0.5);
	motion.v_m_s = 0.8;
	motion.w_rad_s = 0.9;
	motion.b_a = random.vector3(0.05);
	motion.b_g = random.vector3(0.01);
	return motion;
}

test::Blocks statesOf(const test::ConstantTwist& motion, double t0, double t1)
{
	return {test::block(motion.T_WB(t0)), test::block(motion.motion(t0)), test::block(motion.T_WB(t1)), test::block(motion.motion(t1))};
}

Eigen::VectorXd unwhitened(const ImuResidual& cost, const test::Blocks& x)
{
	return cost.whiteningFactor().inverse() * test::residualAt(cost, x);
}
}  // namespace

TEST(ImuResidual, VanishesOnAnExactTurnWithLeverArmAndBiases)
{
	test::Random random(101);
	double worst = 0;
	for (int i = 0; i < 10; ++i)
	{
		const test::ConstantTwist motion = makeMotion(random);
		const ImuResidual cost(motion.imuBetween(0.2, 1.2, motion.b_a, motion.b_g), test::gravity);
		worst = std::max(worst, unwhitened(cost, statesOf(motion, 0.2, 1.2)).cwiseAbs().maxCoeff());
	}
	std::cout << "[measured] ImuResidual at the truth over 1 s: " << worst << " (m, rad, m/s)\n";
	EXPECT_LT(worst, 1e-10);
}

TEST(ImuResidual, CorrectsBiasesToFirstOrder)
{
	test::Random random(102);
	const test::ConstantTwist motion = makeMotion(random);
	const Eigen::Vector3d d_a = random.vector3(1e-2), d_g = random.vector3(1e-3);
	const auto error = [&](double part)
	{
		const ImuResidual cost(motion.imuBetween(0, 1, motion.b_a + part * d_a, motion.b_g + part * d_g), test::gravity);
		return unwhitened(cost, statesOf(motion, 0, 1)).norm();
	};
	std::cout << "[measured] ImuResidual after a bias move: " << error(1) << ", after half of it: " << error(0.5) << "\n";
	EXPECT_LT(error(1), 1e-4);
	EXPECT_NEAR(error(1) / error(0.5), 4, 0.2);
}

TEST(ImuResidual, WhitensWithTheCovariance)
{
	test::Random random(103);
	const test::ConstantTwist motion = makeMotion(random);
	const ImuPreintegration preintegration = motion.imuBetween(0, 0.5, motion.b_a, motion.b_g);
	const ImuResidual::Whitening W = ImuResidual(preintegration, test::gravity).whiteningFactor();
	const double error = (W * preintegration.covariance() * W.transpose() - ImuResidual::Whitening::Identity()).norm();
	std::cout << "[measured] ImuResidual: whitened covariance off identity by " << error << "\n";
	EXPECT_LT(error, 1e-9);
}

TEST(ImuResidual, Jacobians)
{
	test::Random random(104);
	for (const double scale : {0.0, 1e-8, 1.0})
	{
		test::ConstantTwist motion = makeMotion(random);
		motion.v_m_s *= scale;
		motion.w_rad_s *= scale;
		const ImuResidual cost(motion.imuBetween(0, 0.5, scale * motion.b_a, scale * motion.b_g), test::gravity);
		std::vector<test::Blocks> states = test::sampleStates(cost.shapes(), random);
		states.push_back(statesOf(motion, 0, 0.5));
		test::expectJacobians("ImuResidual", cost, states, cost.whiteningFactor().inverse());
		test::expectJacobians("ImuResidual, whitened rows", cost, states);
	}
}

TEST(ImuResidual, JacobiansWithAnOffset)
{
	test::Random random(105);
	const test::ConstantTwist motion = makeMotion(random);
	const ImuTimeShift shift{random.vector(9, 1), 0.003};
	const ImuResidual cost(motion.imuBetween(0, 0.5, motion.b_a, motion.b_g), test::gravity, shift);
	std::vector<test::Blocks> states = test::sampleStates(cost.shapes(), random);
	states.push_back(statesOf(motion, 0, 0.5));
	states.back().push_back({0.003});
	test::expectJacobians("ImuResidual with t_d", cost, states, cost.whiteningFactor().inverse());
}

TEST(ImuResidual, AnOffsetMovesTheInterval)
{
	// Cut 4 ms too late, at the states of the right time: the residual vanishes, to first order, at the offset that says so.
	test::Random random(106);
	const test::ConstantTwist motion = makeMotion(random);
	ImuPreintegration cut = motion.imuBetween(0, 1, motion.b_a, motion.b_g);
	const auto S = random.vector(9, 1);
	const ImuResidual plain(cut, test::gravity), with_offset(cut, test::gravity, {S, 0.01});
	test::Blocks x = statesOf(motion, 0, 1);
	const Eigen::VectorXd without = unwhitened(plain, x);
	x.push_back({0.01});
	EXPECT_EQ((unwhitened(with_offset, x) - without).norm(), 0);
	x.back()[0] = 0.01 + 1e-6;
	const Eigen::VectorXd change = (unwhitened(with_offset, x) - without).head<9>();
	EXPECT_LT((change + 1e-6 * S).norm(), 1e-9);
}
}  // namespace viwo
