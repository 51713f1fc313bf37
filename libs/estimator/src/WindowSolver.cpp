#include "WindowSolver.h"

#include "StateOrder.h"
#include "residuals/LinearPrior.h"
#include "residuals/PoseManifold.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <unordered_set>

namespace viwo
{
namespace
{
bool isLandmark(const LocalCost& cost, size_t block) { return cost.shapes()[block].ambient == 1; }
}  // namespace

SolveReport solveWindow(Window& window, int max_iterations)
{
	const std::vector<Factor> factors = collectFactors(window);
	ceres::Problem::Options problem_options;
	problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.disable_all_safety_checks = true;
	ceres::Problem problem(problem_options);
	PoseManifold pose_manifold;
	ceres::Solver::Options options;
	auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
	options.linear_solver_ordering = ordering;

	std::unordered_set<const double*> known;
	for (const Factor& factor : factors)
	{
		for (size_t i = 0; i < factor.blocks.size(); ++i)
		{
			if (!known.insert(factor.blocks[i]).second) continue;
			const BlockShape& shape = factor.cost->shapes()[i];
			problem.AddParameterBlock(factor.blocks[i], shape.ambient, shape.kind == BlockKind::pose ? &pose_manifold : nullptr);
			ordering->AddElementToGroup(factor.blocks[i], isLandmark(*factor.cost, i) ? 0 : 1);
		}
		problem.AddResidualBlock(factor.cost.get(), factor.loss.get(), factor.blocks);
	}
	options.linear_solver_type = ceres::DENSE_SCHUR;
	options.num_threads = 1;
	options.max_num_iterations = max_iterations;
	options.function_tolerance = 1e-4;
	options.logging_type = ceres::SILENT;
	ceres::Solver::Summary summary;
	ceres::Solve(options, &problem, &summary);
	return {summary.IsSolutionUsable(), static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost};
}

bool latestCovariance(Window& window, Eigen::Matrix<double, 15, 15>& covariance)
{
	Marginalizer marginalizer;
	const double* const pose = window.latest().pose.data();
	const double* const motion = window.latest().motion.data();
	std::unordered_set<const double*> known{pose, motion};
	for (const Factor& factor : collectFactors(window))
	{
		marginalizer.add(factor);
		for (double* block : factor.blocks)
			if (known.insert(block).second) marginalizer.eliminate(block);
	}
	std::vector<double*> blocks;
	Eigen::MatrixXd information;
	if (!marginalizer.remainingInformation(blocks, information) || information.cols() != StateOrder::size) return false;
	const Eigen::LLT<Eigen::MatrixXd> llt(information);
	if (llt.info() != Eigen::Success) return false;
	const Eigen::MatrixXd inverse = llt.solve(Eigen::MatrixXd::Identity(StateOrder::size, StateOrder::size));
	covariance = inverse;
	if (blocks.front() == pose) return true;
	// The factors named the motion block first.
	covariance << inverse.bottomRightCorner<6, 6>(), inverse.bottomLeftCorner<6, 9>(), inverse.topRightCorner<9, 6>(), inverse.topLeftCorner<9, 9>();
	return true;
}
}  // namespace viwo
