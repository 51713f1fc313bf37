#include <DenseMarginal.h>

#include <chrono>

namespace viwo
{
namespace
{
using test::ceresSystem;
using test::concatenate;
using test::DenseSystem;
using test::errorOf;
using test::makeMarginalizer;
using test::oldestOf;
using test::tangentSize;

/** rho = s + s^2: curves upwards, so that Triggs' second-order term is used. */
class Upward : public ceres::LossFunction
{
   public:
	void Evaluate(double s, double rho[3]) const override
	{
		rho[0] = s + s * s;
		rho[1] = 1 + 2 * s;
		rho[2] = 2;
	}
};
}  // namespace

TEST(Marginalizer, AgreesWithTheDenseSchurComplement)
{
	test::SyntheticWindow window(6, 15, 5, 201);
	std::vector<Factor> factors = window.factorsOf(0);
	for (const Factor& f : window.startPriors()) factors.push_back(f);
	for (const bool with_gauge : {false, true})
	{
		if (with_gauge) factors.push_back(window.gaugePrior());
		const auto eliminated = oldestOf(window, 0);
		const MarginalizationResult result = makeMarginalizer(factors, eliminated).run();
		DenseSystem reference(factors, concatenate(eliminated, result.blocks));
		reference.eliminateFirst(tangentSize(eliminated, factors));
		const double error = errorOf(result, reference);
		std::cout << "[measured] Marginalizer against dense Schur" << (with_gauge ? ", with the gauge prior: " : ": ") << error << "\n";
		EXPECT_LT(error, 1e-8);
		EXPECT_EQ(result.skipped_factors, 0);
		EXPECT_TRUE(result.usable());
	}
}

TEST(Marginalizer, AppliesLossesAsCeresDoes)
{
	for (const std::shared_ptr<ceres::LossFunction>& loss :
	     {std::shared_ptr<ceres::LossFunction>(new ceres::HuberLoss(1)), std::shared_ptr<ceres::LossFunction>(new ceres::CauchyLoss(1)),
	      std::shared_ptr<ceres::LossFunction>(new Upward)})
	{
		test::SyntheticWindow window(6, 15, 5, 202, 2);
		window.setLoss(loss);
		std::vector<Factor> factors;
		for (const Factor& f : window.factorsOf(0))
			if (f.loss) factors.push_back(f);
		factors.push_back({std::make_shared<GaugePrior>(poseFromBlock(window.poses[0].data()), Eigen::Vector3d::Zero(), 0.1, 0.1),
		                   nullptr,
		                   {window.poses[0].data()}});
		factors.push_back(window.startPriors()[1]);
		const auto eliminated = concatenate({window.poses[0].data()}, window.landmarksOf(0));
		const MarginalizationResult result = makeMarginalizer(factors, eliminated).run();
		DenseSystem reference = ceresSystem(factors, concatenate(eliminated, result.blocks));
		const DenseSystem unweighted(factors, concatenate(eliminated, result.blocks));
		EXPECT_GT((unweighted.H - reference.H).norm(), 0.02 * reference.H.norm()) << "the loss makes no difference here";
		reference.eliminateFirst(tangentSize(eliminated, factors));
		const double error = errorOf(result, reference);
		std::cout << "[measured] Marginalizer with a robust loss against Ceres: " << error << "\n";
		EXPECT_LT(error, 1e-8);
	}
}

TEST(Marginalizer, KeepsTheFirstLinearizationPointOfAPrior)
{
	test::SyntheticWindow window(6, 15, 5, 203);
	std::vector<Factor> first = window.factorsOf(0);
	for (const Factor& f : window.startPriors()) first.push_back(f);
	const MarginalizationResult prior = makeMarginalizer(first, oldestOf(window, 0)).run();
	window.moveStates(1, 1);

	std::vector<Factor> second = window.factorsOf(1);
	second.push_back({prior.makeCost(), nullptr, prior.blocks});
	const auto eliminated = oldestOf(window, 1);
	const MarginalizationResult result = makeMarginalizer(second, eliminated).run();
	for (size_t i = 0; i < result.blocks.size(); ++i)
	{
		const auto held = std::find(prior.blocks.begin(), prior.blocks.end(), result.blocks[i]);
		const auto k = static_cast<size_t>(held - prior.blocks.begin());
		EXPECT_EQ(result.x0[i], held == prior.blocks.end()
		                            ? std::vector<double>(result.blocks[i], result.blocks[i] + result.shapes[i].ambient)
		                            : prior.x0[k]);
	}

	// run() has frozen the costs of `second`: the reference takes the same Jacobians, and the gradient is that at the present state.
	DenseSystem reference(second, concatenate(eliminated, result.blocks));
	reference.eliminateFirst(tangentSize(eliminated, second));
	const double error = errorOf(result, reference);
	std::cout << "[measured] Marginalizer after the state has moved from x0: " << error << "\n";
	EXPECT_LT(error, 1e-8);
}

TEST(Marginalizer, LandmarksThatMeetInAFactorAreEliminatedTogether)
{
	test::Random random(207);
	std::vector<double> pose = test::block(random.pose(0.5, 1));
	double a = 0.3, b = 0.4;
	const std::vector<BlockShape> shapes{BlockShape::euclidean(1), BlockShape::pose(), BlockShape::euclidean(1)};
	const Eigen::MatrixXd J0 = Eigen::MatrixXd::NullaryExpr(12, 8, [&] { return random.normal(); });
	const Factor factor{
	    std::make_shared<LinearPrior>(shapes, test::Blocks{{0.2}, test::block(random.pose(0.5, 1)), {0.5}}, J0, random.vector(12, 1)),
	    nullptr,
	    {&a, pose.data(), &b}};
	const MarginalizationResult result = makeMarginalizer({factor}, {&a, &b}).run();
	DenseSystem reference({factor}, {&a, &b, pose.data()});
	reference.eliminateFirst(2);
	EXPECT_LT(errorOf(result, reference), 1e-12);
}

TEST(Marginalizer, InformationOfWhatRemainsAgreesWithTheSquareRoot)
{
	test::SyntheticWindow window(6, 15, 5, 211);
	window.setLoss(std::make_shared<ceres::HuberLoss>(1));
	std::vector<double*> all_but_latest{window.T_BC.data(), window.intrinsics.data()};
	for (int k = 0; k < 5; ++k) all_but_latest = concatenate(all_but_latest, oldestOf(window, k));
	// The whole window, where Cholesky will do; and one frame's factors, which leave the normal equations singular.
	for (const bool whole : {true, false})
	{
		std::vector<Factor> factors = whole ? window.factorsFrom(0) : window.factorsOf(0);
		if (whole)
			for (const Factor& f : window.startPriors()) factors.push_back(f);
		if (whole) factors.push_back(window.gaugePrior());
		const auto eliminated = whole ? all_but_latest : oldestOf(window, 0);
		const MarginalizationResult result = makeMarginalizer(factors, eliminated).run();
		std::vector<double*> blocks;
		Eigen::MatrixXd information;
		ASSERT_TRUE(makeMarginalizer(factors, eliminated).remainingInformation(blocks, information));
		EXPECT_EQ(blocks, result.blocks);
		const Eigen::MatrixXd H = result.J0.transpose() * result.J0;
		const Eigen::VectorXd scale = H.diagonal().cwiseSqrt().cwiseInverse();
		const double error = (scale.asDiagonal() * (information - H) * scale.asDiagonal()).cwiseAbs().maxCoeff();
		std::cout << "[measured] information of what remains against the square root: " << error << "\n";
		EXPECT_LT(error, 1e-8);
	}
}

TEST(Marginalizer, DirectionsThatNothingDeterminesTakeNothingAway)
{
	// a_0 = -b_0 + noise, b known, a_1 unknown to all: what is known of b stays.
	Eigen::MatrixXd J0 = Eigen::MatrixXd::Zero(3, 4);
	J0(0, 0) = J0(0, 2) = J0(1, 2) = J0(2, 3) = 1;
	std::vector<double> a{1, 2}, b{3, 4};
	const Factor factor{std::make_shared<LinearPrior>(std::vector<BlockShape>(2, BlockShape::euclidean(2)), test::Blocks{a, b}, J0,
	                                                  Eigen::Vector3d(5, 6, 7)),
	                    nullptr,
	                    {a.data(), b.data()}};
	const MarginalizationResult result = makeMarginalizer({factor}, {a.data()}).run();
	EXPECT_LT((result.J0.transpose() * result.J0 - Eigen::Matrix2d::Identity()).norm(), 1e-14);
	EXPECT_LT((result.J0.transpose() * result.r0 - Eigen::Vector2d(6, 7)).norm(), 1e-14);
}

TEST(Marginalizer, LeavesOutObservationsBehindTheCamera)
{
	test::SyntheticWindow window(4, 5, 3, 208);
	*window.landmarksOf(0)[0] = 1e3;  // a millimetre before the first camera
	const MarginalizationResult result = makeMarginalizer(window.factorsOf(0), oldestOf(window, 0)).run();
	EXPECT_EQ(result.skipped_factors, 3);
	EXPECT_TRUE(result.usable());
}

TEST(Marginalizer, SaysWhenNothingRemains)
{
	double x = 1;
	const Factor factor{std::make_shared<StatePrior>(BlockShape::euclidean(1), &x, Eigen::VectorXd::Ones(1)), nullptr, {&x}};
	const MarginalizationResult result = makeMarginalizer({factor}, {&x}).run();
	EXPECT_TRUE(result.blocks.empty());
	EXPECT_FALSE(result.usable());
}

TEST(Marginalizer, SameBytesWhereverTheBlocksLie)
{
	test::SyntheticWindow one(6, 15, 5, 209);
	const std::vector<std::vector<double>> elsewhere(1000, std::vector<double>(17));
	test::SyntheticWindow two(6, 15, 5, 209);
	const MarginalizationResult a = makeMarginalizer(one.factorsOf(0), oldestOf(one, 0)).run();
	const MarginalizationResult b = makeMarginalizer(two.factorsOf(0), oldestOf(two, 0)).run();
	EXPECT_EQ(a.x0, b.x0);
	EXPECT_EQ(a.J0, b.J0);
	EXPECT_EQ(a.r0, b.r0);
	EXPECT_EQ(a.blocks[0], one.poses[1].data()) << "blocks come in order of first appearance";
}

TEST(Marginalizer, IsFastEnoughForEveryKeyframe)
{
	test::SyntheticWindow window(12, 100, 6, 210);
	// Frame 1 with 100 landmarks, and a prior from frame 0.
	const MarginalizationResult prior = makeMarginalizer(window.factorsOf(0), oldestOf(window, 0)).run();
	std::vector<Factor> factors = window.factorsOf(1);
	factors.push_back({prior.makeCost(), nullptr, prior.blocks});
	const auto eliminated = oldestOf(window, 1);
	const auto best_ms = [&](const auto& work)
	{
		double best = 1e9;
		for (int repeat = 0; repeat < 5; ++repeat)
		{
			const auto start = std::chrono::steady_clock::now();
			work();
			best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
		}
		return best;
	};
	std::vector<double*> blocks;
	Eigen::MatrixXd information;
	const double run_ms = best_ms([&] { EXPECT_TRUE(makeMarginalizer(factors, eliminated).run().usable()); });
	const double information_ms = best_ms([&] { makeMarginalizer(factors, eliminated).remainingInformation(blocks, information); });
	std::cout << "[measured] Marginalizer: " << factors.size() << " factors, 100 landmarks, " << information.cols()
	          << " columns left: " << run_ms << " ms; information only: " << information_ms << " ms\n";
	EXPECT_LT(run_ms, 1000) << "even under a sanitizer on a busy machine";
}
}  // namespace viwo
