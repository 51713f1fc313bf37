#pragma once

#include "FactorSet.h"
#include "StateCopies.h"

#include <ceres/manifold.h>
#include <ceres/solver.h>

#include <functional>
#include <vector>

namespace viwo
{
/** What a solver is to do with each state. */
struct StateRoles
{
	using State = StateCopies::State;

	std::function<ceres::Manifold*(const State&)> manifold;  //!< null: Euclidean; not owned
	std::function<bool(const State&)> held;                  //!< not moved
	std::function<bool(const State&)> eliminated_first;      //!< in the Schur complement: landmarks
};

/** Minimises the factors over their states, which it moves, with Ceres in one thread: the result depends on nothing but the arguments.
 *  @param options linear solver, iterations and tolerance; the rest is set here. */
ceres::Solver::Summary solveFactors(const std::vector<Factor>& factors, const StateRoles& roles, ceres::Solver::Options options);
}  // namespace viwo
