#include <Marginalizer.h>

#include <NumericJacobian.h>
#include <SyntheticWindow.h>

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>

#include <Eigen/LU>
#include <chrono>

namespace viwo
{
namespace
{
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/** Normal equations of a set of factors over the given blocks, dense and in extended precision. */
struct DenseSystem
{
	DenseSystem(const std::vector<Factor>& factors, const std::vector<double*>& order)
	{
		std::map<double*, int> offset;
		std::map<double*, BlockShape> shape;
		for (const Factor& f : factors)
			for (size_t i = 0; i < f.blocks.size(); ++i) shape[f.blocks[i]] = f.cost->shapes()[i];
		int size = 0;
		for (double* block : order)
		{
			offset[block] = size;
			size += shape.at(block).tangent;
		}
		H = LongMatrix::Zero(size, size);
		g = LongVector::Zero(size);
		for (const Factor& f : factors) add(f, offset);
	}

	void add(const Factor& f, const std::map<double*, int>& offset)
	{
		LongMatrix J = LongMatrix::Zero(f.cost->num_residuals(), g.size());
		std::vector<test::RowMajor> local;
		std::vector<double*> p;
		for (const BlockShape& s : f.cost->shapes()) local.emplace_back(f.cost->num_residuals(), s.tangent);
		for (auto& l : local) p.push_back(l.data());
		Eigen::VectorXd r(f.cost->num_residuals());
		ASSERT_TRUE(f.cost->linearize(f.blocks.data(), r.data(), p.data()));
		for (size_t i = 0; i < local.size(); ++i) J.middleCols(offset.at(f.blocks[i]), local[i].cols()) += local[i].cast<long double>();
		H += J.transpose() * J;
		g += J.transpose() * r.cast<long double>();
	}

	/** Schur complement of all but the first m columns. */
	void eliminateFirst(Eigen::Index m)
	{
		const Eigen::Index n = g.size() - m;
		const LongMatrix K = H.topLeftCorner(m, m).fullPivLu().solve(H.topRightCorner(m, n));
		g = (g.tail(n) - K.transpose() * g.head(m)).eval();
		H = (H.bottomRightCorner(n, n) - H.bottomLeftCorner(n, m) * K).eval();
	}

	LongMatrix H;
	LongVector g;
};

/** Normal equations as Ceres itself assembles them, losses applied, through PoseManifold. */
DenseSystem ceresSystem(const std::vector<Factor>& factors, const std::vector<double*>& order)
{
	DenseSystem system({}, {});
	ceres::Problem::Options options;
	options.cost_function_ownership = options.loss_function_ownership = options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	ceres::Problem problem(options);
	PoseManifold pose;
	for (const Factor& f : factors)
	{
		problem.AddResidualBlock(f.cost.get(), f.loss.get(), f.blocks);
		for (size_t i = 0; i < f.blocks.size(); ++i)
			if (f.cost->shapes()[i].kind == BlockKind::pose) problem.SetManifold(f.blocks[i], &pose);
	}
	ceres::Problem::EvaluateOptions evaluate;
	evaluate.parameter_blocks = order;
	std::vector<double> r;
	ceres::CRSMatrix crs;
	problem.Evaluate(evaluate, nullptr, &r, nullptr, &crs);
	LongMatrix J = LongMatrix::Zero(crs.num_rows, crs.num_cols);
	for (int row = 0; row < crs.num_rows; ++row)
		for (int k = crs.rows[size_t(row)]; k < crs.rows[size_t(row) + 1]; ++k) J(row, crs.cols[size_t(k)]) = crs.values[size_t(k)];
	system.H = J.transpose() * J;
	system.g = J.transpose() * Eigen::Map<Eigen::VectorXd>(r.data(), Eigen::Index(r.size())).cast<long double>();
	return system;
}

Marginalizer makeMarginalizer(const std::vector<Factor>& factors, const std::vector<double*>& eliminated)
{
	Marginalizer marginalizer;
	for (const Factor& f : factors) marginalizer.add(f);
	for (double* block : eliminated) marginalizer.eliminate(block);
	return marginalizer;
}

/** Relative error of J0^T J0 and of the gradient at the present state, in units of the diagonal. */
double errorOf(const MarginalizationResult& result, const DenseSystem& reference)
{
	const auto cost = result.makeCost();
	Eigen::VectorXd r(result.r0.size());
	std::vector<const double*> x(result.blocks.begin(), result.blocks.end());
	cost->evaluateLocal(x.data(), r.data(), nullptr);
	const LongMatrix J0 = result.J0.cast<long double>();
	const LongVector scale = reference.H.diagonal().cwiseSqrt().cwiseInverse();
	const LongMatrix dH = scale.asDiagonal() * (J0.transpose() * J0 - reference.H) * scale.asDiagonal();
	const LongVector dg = scale.asDiagonal() * (J0.transpose() * r.cast<long double>() - reference.g);
	const LongVector g = scale.asDiagonal() * reference.g;
	return double(std::max(dH.cwiseAbs().maxCoeff(), dg.norm() / g.norm()));
}

int tangentSize(const std::vector<double*>& blocks, const std::vector<Factor>& factors)
{
	int size = 0;
	for (double* block : blocks)
	{
		int own = 0;
		for (const Factor& f : factors)
			for (size_t i = 0; i < f.blocks.size(); ++i)
				if (f.blocks[i] == block) own = f.cost->shapes()[i].tangent;
		size += own;
	}
	return size;
}

std::vector<double*> concatenate(std::vector<double*> a, const std::vector<double*>& b)
{
	a.insert(a.end(), b.begin(), b.end());
	return a;
}

std::vector<double*> oldestOf(test::SyntheticWindow& window, int k)
{
	return concatenate({window.poses[size_t(k)].data(), window.motions[size_t(k)].data()}, window.landmarksOf(k));
}

/** Translation in x, y, z and yaw about W's vertical, in the tangent coordinates of each block at its linearisation point. */
Eigen::MatrixXd gaugeDirections(const std::vector<BlockShape>& shapes, const std::vector<const double*>& at)
{
	Eigen::Index size = 0;
	for (const BlockShape& shape : shapes) size += shape.tangent;
	Eigen::MatrixXd N = Eigen::MatrixXd::Zero(size, 4);
	Eigen::Index row = 0;
	for (size_t i = 0; i < shapes.size(); ++i)
	{
		const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
		// The only pose that the gauge does not move is T_BC, which is told apart by its place: callers pass nullptr for it.
		if (at[i] && shapes[i].kind == BlockKind::pose)
		{
			const Pose3 T = poseFromBlock(at[i]);
			N.block<3, 3>(row, 0).setIdentity();
			N.block<3, 1>(row, 3) = up.cross(T.p);
			N.block<3, 1>(row + 3, 3) = T.R.conjugate() * up;
		}
		if (at[i] && shapes[i].tangent == 9) N.block<3, 1>(row, 3) = up.cross(Eigen::Map<const Eigen::Vector3d>(at[i]));
		row += shapes[i].tangent;
	}
	return N;
}

/** Largest |H n| / (|H| |n|), and largest information along a gauge direction over that of the states it moves: n^T H n / n^T diag(H) n. */
std::pair<double, double> gaugeInformation(const Eigen::MatrixXd& H, const Eigen::MatrixXd& N)
{
	double product = 0, information = 0;
	for (int i = 0; i < 4; ++i)
	{
		const Eigen::VectorXd n = N.col(i);
		product = std::max(product, (H * n).norm() / (H.norm() * n.norm()));
		information = std::max(information, std::abs(n.dot(H * n)) / n.cwiseAbs2().dot(H.diagonal()));
	}
	return {product, information};
}

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
		factors.push_back(
		    {std::make_shared<GaugePrior>(poseFromBlock(window.poses[0].data()), Eigen::Vector3d::Zero(), 0.1, 0.1), nullptr, {window.poses[0].data()}});
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

TEST(Marginalizer, GaugeStaysInTheNullSpaceOverFiveMarginalizations)
{
	for (const bool robust : {false, true})
	{
		test::SyntheticWindow window(11, 15, 5, 204);
		if (robust) window.setLoss(std::make_shared<ceres::HuberLoss>(1));
		std::vector<Factor> prior = window.startPriors();  // none of them fixes the gauge
		MarginalizationResult result;
		for (int k = 0; k < 5; ++k)
		{
			Marginalizer marginalizer = makeMarginalizer(window.factorsOf(k), oldestOf(window, k));
			for (const Factor& f : prior) marginalizer.add(f);
			result = marginalizer.run();
			ASSERT_TRUE(result.usable());
			prior = {{result.makeCost(), nullptr, result.blocks}};
			window.moveStates(k + 1, 1);
		}
		std::vector<const double*> at_x0, at_x;
		for (size_t i = 0; i < result.blocks.size(); ++i)
		{
			const bool extrinsics = result.blocks[i] == window.T_BC.data();
			at_x0.push_back(extrinsics ? nullptr : result.x0[i].data());
			at_x.push_back(extrinsics ? nullptr : result.blocks[i]);
		}
		const Eigen::MatrixXd H = result.J0.transpose() * result.J0;
		const auto [product, information] = gaugeInformation(H, gaugeDirections(result.shapes, at_x0));
		const auto [product_moved, information_moved] = gaugeInformation(H, gaugeDirections(result.shapes, at_x));
		std::cout << "[measured] gauge after five marginalisations" << (robust ? ", Huber: " : ": ") << "|Hn|/|H||n| " << product
		          << ", information over the diagonal's " << information << " (were Jacobians not frozen: about " << product_moved << ", "
		          << information_moved << ")\n";
		EXPECT_LT(product, 1e-8);
		EXPECT_LT(information, 1e-8);
		EXPECT_GT(product_moved, 1e-7) << "the states have not moved enough for the test to mean anything";
	}
}

TEST(Marginalizer, GaugeStaysInTheNullSpaceOfTheWindowThatRemains)
{
	test::SyntheticWindow window(11, 15, 5, 205);
	std::vector<Factor> prior = window.startPriors();
	for (int k = 0; k < 5; ++k)
	{
		Marginalizer marginalizer = makeMarginalizer(window.factorsOf(k), oldestOf(window, k));
		for (const Factor& f : prior) marginalizer.add(f);
		const MarginalizationResult result = marginalizer.run();
		prior = {{result.makeCost(), nullptr, result.blocks}};
		window.moveStates(k + 1, 1);
	}
	// The window's factors on states of the prior, frozen as a window has to freeze them.
	const Factor& held = prior[0];
	std::vector<Factor> factors = window.factorsFrom(5);
	for (const Factor& f : factors)
		for (size_t i = 0; i < f.blocks.size(); ++i)
			for (size_t k = 0; k < held.blocks.size(); ++k)
				if (held.blocks[k] == f.blocks[i]) f.cost->freeze(int(i), held.cost->linearizationPoint(int(k)));
	factors.push_back(held);

	std::vector<double*> order;
	std::vector<BlockShape> shapes;
	std::vector<const double*> at;
	for (const Factor& f : factors)
		for (size_t i = 0; i < f.blocks.size(); ++i)
		{
			if (std::find(order.begin(), order.end(), f.blocks[i]) != order.end()) continue;
			const double* x0 = f.cost->linearizationPoint(int(i));
			order.push_back(f.blocks[i]);
			shapes.push_back(f.cost->shapes()[i]);
			at.push_back(f.blocks[i] == window.T_BC.data() ? nullptr : (x0 ? x0 : f.blocks[i]));
		}
	const DenseSystem system(factors, order);
	const auto [product, information] = gaugeInformation(system.H.cast<double>(), gaugeDirections(shapes, at));
	std::cout << "[measured] gauge in the whole window: |Hn|/|H||n| " << product << ", information over the diagonal's " << information
	          << "\n";
	EXPECT_LT(product, 1e-8);
	EXPECT_LT(information, 1e-8);
}

TEST(Marginalizer, KeepsTheAbsolutePositionThroughALongDrive)
{
	const int frames = 15;
	test::SyntheticWindow window(frames, 3, 3, 206, 0);
	std::vector<Factor> prior = window.startPriors();
	prior.push_back(window.gaugePrior());
	MarginalizationResult result;
	for (int k = 0; k + 1 < frames; ++k)
	{
		Marginalizer marginalizer = makeMarginalizer(window.factorsOf(k), oldestOf(window, k));
		for (const Factor& f : prior) marginalizer.add(f);
		result = marginalizer.run();
		prior = {{result.makeCost(), nullptr, result.blocks}};
	}
	std::vector<Factor> all = window.factorsFrom(0);
	for (const Factor& f : window.startPriors()) all.push_back(f);
	all.push_back(window.gaugePrior());
	std::vector<double*> order;
	for (int k = 0; k + 1 < frames; ++k) order = concatenate(order, oldestOf(window, k));
	const int eliminated = tangentSize(order, all);
	const DenseSystem system(all, concatenate(order, result.blocks));
	const LongMatrix covariance = system.H.ldlt()
	                                  .solve(LongMatrix::Identity(system.H.rows(), system.H.cols()))
	                                  .bottomRightCorner(system.H.rows() - eliminated, system.H.cols() - eliminated);
	const Eigen::MatrixXd H = result.J0.transpose() * result.J0;
	const Eigen::MatrixXd found = H.ldlt().solve(Eigen::MatrixXd::Identity(H.rows(), H.cols()));
	const double worst = (found.diagonal().array() / covariance.diagonal().cast<double>().array() - 1).abs().maxCoeff();
	std::cout << "[measured] variances after " << frames - 1 << " marginalisations against the batch: relative error " << worst << "\n";
	EXPECT_LT(worst, 1e-8);
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
