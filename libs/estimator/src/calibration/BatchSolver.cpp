#include "calibration/BatchSolver.h"

#include "FactorSolver.h"
#include "residuals/PoseManifold.h"

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

	PoseManifold pose_manifold;
	StateRoles roles;
	roles.manifold = [&](const StateCopies::State& state) { return state.shape.kind == BlockKind::pose ? &pose_manifold : nullptr; };
	roles.held = [&](const StateCopies::State& state) { return std::find(fixed.begin(), fixed.end(), state.original) != fixed.end(); };
	roles.eliminated_first = [&](const StateCopies::State& state) { return depths.count(state.original) > 0; };
	ceres::Solver::Options options;
	options.linear_solver_type = ceres::SPARSE_SCHUR;
	options.max_num_iterations = max_iterations;
	options.function_tolerance = 1e-6;
	return solveFactors(factors, roles, options).IsSolutionUsable();
}
}  // namespace viwo
