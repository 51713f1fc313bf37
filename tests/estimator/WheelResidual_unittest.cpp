#include <residuals/WheelResidual.h>

#include <ConstantTwist.h>
#include <CovarianceComparison.h>
#include <NumericJacobian.h>

namespace viwo
{
namespace
{
/** 0.5 m lever arm, B tilted against O. */
test::ConstantTwist makeMotion(test::Random& random)
{
	test::ConstantTwist motion;
	motion.T_WO0 = random.pose(0.8, 2);
	motion.T_BO = {random.pose(0.8, 0).R, 0.5 * random.vector3(1).normalized()};
	motion.v_m_s = 0.3;
	motion.w_rad_s = 0.9;
	motion.wheels = {1.01, 0.98, 0.231};
	return motion;
}

std::vector<double> block(const WheelIntrinsics& k)
{
	return {k.k_left, k.k_right, k.track_m};
}

test::Blocks statesOf(const test::ConstantTwist& motion, double t0, double t1)
{
	return {test::block(motion.T_WB(t0)), test::block(motion.T_WB(t1)), block(motion.wheels)};
}
}  // namespace

TEST(WheelResidual, VanishesOnAnExactArcWithLeverArm)
{
	test::Random random(111);
	double worst = 0;
	for (int i = 0; i < 10; ++i)
	{
		const test::ConstantTwist motion = makeMotion(random);
		const WheelResidual cost(motion.wheelsBetween(0.2, 1.2, motion.wheels), motion.T_BO);
		const Eigen::VectorXd r = cost.whiteningFactor().inverse() * test::residualAt(cost, statesOf(motion, 0.2, 1.2));
		worst = std::max(worst, r.cwiseAbs().maxCoeff());
	}
	std::cout << "[measured] WheelResidual at the truth over 1 s, 0.5 m lever arm: " << worst << " (m, rad)\n";
	EXPECT_LT(worst, 1e-13);
}

TEST(WheelResidual, CorrectsIntrinsicsToFirstOrder)
{
	test::Random random(112);
	const test::ConstantTwist motion = makeMotion(random);
	const auto error = [&](double part)
	{
		const WheelIntrinsics at{motion.wheels.k_left + part * 0.01, motion.wheels.k_right - part * 0.01,
		                         motion.wheels.track_m + part * 0.002};
		const WheelResidual cost(motion.wheelsBetween(0, 1, at), motion.T_BO);
		return (cost.whiteningFactor().inverse() * test::residualAt(cost, statesOf(motion, 0, 1))).norm();
	};
	std::cout << "[measured] WheelResidual after the intrinsics moved by 1 %: " << error(1) << ", by 0.5 %: " << error(0.5) << "\n";
	EXPECT_LT(error(1), 3e-3);
	EXPECT_NEAR(error(1) / error(0.5), 4, 0.2);
}

TEST(WheelResidual, WhitensWithTheInflatedCovariance)
{
	test::Random random(113);
	const test::ConstantTwist motion = makeMotion(random);
	const WheelPreintegration preintegration = motion.wheelsBetween(0, 0.1, motion.wheels);
	const WheelResidual::Whitening W = WheelResidual(preintegration, motion.T_BO, 9).whiteningFactor();
	const double error = (9 * W * preintegration.covariance() * W.transpose() - WheelResidual::Whitening::Identity()).norm();
	std::cout << "[measured] WheelResidual: whitened covariance off identity by " << error << "\n";
	EXPECT_LT(error, 1e-10);
}

/** Many intervals between known poses: what their noise does to the size of the wheels must cancel out. */
TEST(WheelResidual, NoiseOfTheWheelsPullsTheirSizeNowhere)
{
	test::Random random(116);
	test::ConstantTwist motion = makeMotion(random);
	motion.v_m_s = 0.015;
	motion.w_rad_s = 0.01;
	WheelNoise noise;
	noise.s0_m_s_sqrtHz = 0.003;  // so much that an interval says little of the size, and its noise a lot
	const auto wheels = motion.wheels;
	const double left = (motion.v_m_s - 0.5 * wheels.track_m * motion.w_rad_s) / wheels.k_left;
	const double right = (motion.v_m_s + 0.5 * wheels.track_m * motion.w_rad_s) / wheels.k_right, dt_s = 0.1;
	const auto deviation = [&](double v_m_s) { return std::hypot(noise.s0_m_s_sqrtHz, noise.k_sqrtHz * v_m_s) / std::sqrt(dt_s); };
	const test::Blocks x = statesOf(motion, 0, dt_s);
	const double* const states[] = {x[0].data(), x[1].data(), x[2].data()};
	Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
	const int draws = test::monteCarloDraws(40000);
	for (int i = 0; i < draws; ++i)
	{
		WheelPreintegration preintegration(noise, wheels);
		const Eigen::VectorXd e = random.vector(2, 1);
		preintegration.integrate({dt_s, left + e[0] * deviation(left), right + e[1] * deviation(right)});
		const WheelResidual cost(preintegration, motion.T_BO);
		Eigen::Matrix<double, 6, 1> r;
		Eigen::Matrix<double, 6, 3, Eigen::RowMajor> J;
		double* jacobians[] = {nullptr, nullptr, J.data()};
		ASSERT_TRUE(cost.evaluateLocal(states, r.data(), jacobians));
		const Eigen::Vector3d pull = J.transpose() * r;
		sum += pull;
		squares += pull.cwiseAbs2();
	}
	const Eigen::Vector3d mean = sum / draws, deviations = (squares / draws - mean.cwiseAbs2()).cwiseSqrt() / std::sqrt(draws);
	for (int i = 0; i < 3; ++i)
	{
		std::cout << "[measured] pull of an interval's noise on intrinsic " << i << ": " << mean[i] << " +- " << deviations[i] << "\n";
		EXPECT_LT(std::abs(mean[i]), 4 * deviations[i]);
	}
}

TEST(WheelResidual, Jacobians)
{
	test::Random random(114);
	for (const double scale : {0.0, 1e-8, 1.0})
	{
		test::ConstantTwist motion = makeMotion(random);
		motion.v_m_s *= scale;
		motion.w_rad_s *= scale;
		if (scale == 0) motion.T_BO = Pose3();
		const WheelIntrinsics at{1, 1, 0.23};
		const WheelResidual cost(motion.wheelsBetween(0, 0.5, at), motion.T_BO);
		std::vector<test::Blocks> states = test::sampleStates(cost.shapes(), random);
		for (test::Blocks& x : states)
		{
			const Eigen::Vector3d moved = Eigen::Vector3d(1, 1, 0.23) + random.vector3(0.02);
			x[2] = test::block(moved);
		}
		states.push_back(statesOf(motion, 0, 0.5));
		test::expectJacobians("WheelResidual", cost, states, cost.whiteningFactor().inverse());
		test::expectJacobians("WheelResidual, whitened rows", cost, states);
	}
}

TEST(WheelResidual, JacobiansWithMountingAndOffsets)
{
	test::Random random(115);
	const test::ConstantTwist motion = makeMotion(random);
	const WheelResidual cost(motion.wheelsBetween(0, 0.5, motion.wheels), WheelTimeShift{random.vector(6, 1), 0.004});
	std::vector<test::Blocks> states = test::sampleStates(cost.shapes(), random);
	for (test::Blocks& x : states) x[2] = test::block(Eigen::Vector3d(Eigen::Vector3d(1, 1, 0.23) + random.vector3(0.02)));
	test::Blocks truth = statesOf(motion, 0, 0.5);
	truth.insert(truth.end(), {test::block(motion.T_BO), {0.007}, {0.003}});
	EXPECT_LT((cost.whiteningFactor().inverse() * test::residualAt(cost, truth)).norm(), 1e-12);
	states.push_back(truth);
	test::expectJacobians("WheelResidual with T_BO, t_d, t_w", cost, states, cost.whiteningFactor().inverse());
}
}  // namespace viwo
