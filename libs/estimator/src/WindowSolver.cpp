#include "WindowSolver.h"

#include "StateOrder.h"
#include "residuals/LinearPrior.h"
#include "residuals/PoseManifold.h"

#include <viwo/sfm/ScopedQuietLog.h>

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace viwo
{
namespace
{
bool isLandmark(const BlockShape& shape) { return shape.ambient == 1; }

/** Ceres orders the blocks of a group by their addresses: copies in one array, in the order of the factors, make that order repeatable. */
class StateCopies
{
   public:
	explicit StateCopies(const std::vector<Factor>& factors)
	{
		size_t size = 0;
		for (const Factor& factor : factors)
			for (size_t i = 0; i < factor.blocks.size(); ++i)
			{
				const BlockShape& shape = factor.cost->shapes()[i];
				if (!offsets_.emplace(factor.blocks[i], size).second) continue;
				states_.push_back({factor.blocks[i], shape});
				size += static_cast<size_t>(shape.ambient);
			}
		values_.reserve(size);
		for (const State& s : states_) values_.insert(values_.end(), s.original, s.original + s.shape.ambient);
	}

	struct State
	{
		double* original;
		BlockShape shape;
	};
	const std::vector<State>& states() const { return states_; }
	double* copyOf(const double* original) { return values_.data() + offsets_.at(original); }
	void writeBack()
	{
		for (const State& s : states_) std::copy_n(copyOf(s.original), s.shape.ambient, s.original);
	}

   private:
	std::unordered_map<const double*, size_t> offsets_;	 // looked up only, never walked through
	std::vector<State> states_;
	std::vector<double> values_;
};
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

	StateCopies copies(factors);
	for (const StateCopies::State& state : copies.states())
	{
		double* const copy = copies.copyOf(state.original);
		problem.AddParameterBlock(copy, state.shape.ambient, state.shape.kind == BlockKind::pose ? &pose_manifold : nullptr);
		ordering->AddElementToGroup(copy, isLandmark(state.shape) ? 0 : 1);
	}
	for (const Factor& factor : factors)
	{
		std::vector<double*> blocks;
		for (const double* block : factor.blocks) blocks.push_back(copies.copyOf(block));
		problem.AddResidualBlock(factor.cost.get(), factor.loss.get(), blocks);
	}
	options.linear_solver_type = ceres::DENSE_SCHUR;
	options.num_threads = 1;
	options.max_num_iterations = max_iterations;
	options.function_tolerance = 1e-4;
	options.logging_type = ceres::SILENT;
	ceres::Solver::Summary summary;
	const ScopedQuietLog quiet;
	ceres::Solve(options, &problem, &summary);
	copies.writeBack();
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
