#include "FactorSolver.h"

#include <viwo/sfm/ScopedQuietLog.h>

#include <ceres/problem.h>

#include <memory>

namespace viwo
{
ceres::Solver::Summary solveFactors(const std::vector<Factor>& factors, const StateRoles& roles, ceres::Solver::Options options)
{
	ceres::Problem::Options problem_options;
	problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.disable_all_safety_checks = true;
	ceres::Problem problem(problem_options);
	auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();

	StateCopies copies(factors);
	for (const StateCopies::State& state : copies.states())
	{
		double* const copy = copies.copyOf(state.original);
		problem.AddParameterBlock(copy, state.shape.ambient, roles.manifold(state));
		if (roles.held(state)) problem.SetParameterBlockConstant(copy);
		ordering->AddElementToGroup(copy, roles.eliminated_first(state) ? 0 : 1);
	}
	for (const Factor& factor : factors)
	{
		std::vector<double*> blocks;
		for (const double* block : factor.blocks) blocks.push_back(copies.copyOf(block));
		problem.AddResidualBlock(factor.cost.get(), factor.loss.get(), blocks);
	}
	options.linear_solver_ordering = ordering;
	options.num_threads = 1;
	options.logging_type = ceres::SILENT;
	ceres::Solver::Summary summary;
	const ScopedQuietLog quiet;
	ceres::Solve(options, &problem, &summary);
	copies.writeBack();
	return summary;
}
}  // namespace viwo
