#include "calibration/BatchSolver.h"

#include "StateCopies.h"
#include "residuals/PoseManifold.h"

#include <viwo/sfm/ScopedQuietLog.h>

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <unordered_set>

namespace viwo
{
bool solveBatch(const std::vector<BatchFactor>& batch, const LandmarkMap& landmarks, const std::vector<const double*>& fixed,
                int max_iterations)
{
	std::vector<Factor> factors;
	for (const BatchFactor& f : batch) factors.push_back(f.factor);
	std::unordered_set<const double*> depths;  // looked up only, never walked through
	for (const auto& [id, landmark] : landmarks.all()) depths.insert(&landmark.inverse_depth_1_m);

	ceres::Problem::Options problem_options;
	problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	problem_options.disable_all_safety_checks = true;
	PoseManifold pose_manifold;
	ceres::Problem problem(problem_options);
	ceres::Solver::Options options;
	auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
	options.linear_solver_ordering = ordering;
	StateCopies copies(factors);
	for (const StateCopies::State& state : copies.states())
	{
		double* const copy = copies.copyOf(state.original);
		problem.AddParameterBlock(copy, state.shape.ambient, state.shape.kind == BlockKind::pose ? &pose_manifold : nullptr);
		ordering->AddElementToGroup(copy, depths.count(state.original) > 0 ? 0 : 1);
		if (std::find(fixed.begin(), fixed.end(), state.original) != fixed.end()) problem.SetParameterBlockConstant(copy);
	}
	for (const Factor& factor : factors)
	{
		std::vector<double*> blocks;
		for (const double* block : factor.blocks) blocks.push_back(copies.copyOf(block));
		problem.AddResidualBlock(factor.cost.get(), factor.loss.get(), blocks);
	}
	options.linear_solver_type = ceres::SPARSE_SCHUR;
	options.num_threads = 1;
	options.max_num_iterations = max_iterations;
	options.function_tolerance = 1e-6;
	options.logging_type = ceres::SILENT;
	ceres::Solver::Summary summary;
	const ScopedQuietLog quiet;
	ceres::Solve(options, &problem, &summary);
	copies.writeBack();
	return summary.IsSolutionUsable();
}
}  // namespace viwo
