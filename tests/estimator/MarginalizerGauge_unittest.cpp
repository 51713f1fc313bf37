#include <DenseMarginal.h>

namespace viwo
{
namespace
{
using test::concatenate;
using test::DenseSystem;
using test::LongMatrix;
using test::makeMarginalizer;
using test::oldestOf;
using test::tangentSize;

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
}  // namespace

TEST(MarginalizerGauge, GaugeStaysInTheNullSpaceOverFiveMarginalizations)
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

TEST(MarginalizerGauge, GaugeStaysInTheNullSpaceOfTheWindowThatRemains)
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

TEST(MarginalizerGauge, KeepsTheAbsolutePositionThroughALongDrive)
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
}  // namespace viwo
