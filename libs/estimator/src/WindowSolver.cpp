#include "WindowSolver.h"

#include "FactorSolver.h"
#include "OnlineCalibration.h"
#include "StateOrder.h"
#include "residuals/LinearPrior.h"
#include "residuals/PartialPoseManifold.h"
#include "residuals/PoseManifold.h"

#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <array>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace viwo
{
namespace
{
/** Offsets are one number, too, but meet each other in the wheel factors. */
bool isLandmark(const Window& window, const double* block, const BlockShape& shape)
{
	return shape.ambient == 1 && block != &window.t_d_s && block != &window.t_w_s;
}

/** In which directions the solver may move each state. */
class StateManifolds
{
   public:
	explicit StateManifolds(const Window& window) : window_(window), freedom_(freedomOf(window))
	{
		const CalibrationFreedom& f = freedom_;
		if (f.mounting())
			mounting_ =
			    std::make_unique<PartialPoseManifold>(std::array<bool, 6>{f.lever_arm, f.lever_arm, f.lever_arm, f.tilt, f.tilt, f.yaw});
	}

	ceres::Manifold* of(const StateCopies::State& state)
	{
		if (mounting_ && state.original == window_.T_BO.data()) return mounting_.get();
		return state.shape.kind == BlockKind::pose ? &pose_ : nullptr;
	}
	bool held(const StateCopies::State& state) const
	{
		const double* const block = state.original;
		return (block == window_.T_BO.data() && !freedom_.mounting()) || (block == &window_.t_d_s && !freedom_.camera_offset) ||
		       (block == &window_.t_w_s && !freedom_.wheel_offset);
	}

   private:
	const Window& window_;
	CalibrationFreedom freedom_;
	PoseManifold pose_;
	std::unique_ptr<PartialPoseManifold> mounting_;
};
}  // namespace

SolveReport solveWindow(Window& window, int max_iterations)
{
	StateManifolds manifolds(window);
	StateRoles roles;
	roles.manifold = [&](const StateCopies::State& state) { return manifolds.of(state); };
	roles.held = [&](const StateCopies::State& state) { return manifolds.held(state); };
	roles.eliminated_first = [&](const StateCopies::State& state) { return isLandmark(window, state.original, state.shape); };
	ceres::Solver::Options options;
	options.linear_solver_type = ceres::DENSE_SCHUR;
	options.max_num_iterations = max_iterations;
	options.function_tolerance = 1e-4;
	const ceres::Solver::Summary summary = solveFactors(collectFactors(window), roles, options);
	return {summary.IsSolutionUsable(), static_cast<int>(summary.iterations.size())};
}

bool marginalCovariance(Window& window, const std::vector<double*>& wanted, Eigen::MatrixXd& covariance)
{
	Marginalizer marginalizer;
	std::unordered_set<const double*> known(wanted.begin(), wanted.end());
	std::unordered_map<const double*, Eigen::Index> size;  // looked up only, never walked through
	for (const Factor& factor : collectFactors(window))
	{
		marginalizer.add(factor);
		for (size_t i = 0; i < factor.blocks.size(); ++i)
		{
			size[factor.blocks[i]] = factor.cost->shapes()[i].tangent;
			if (known.insert(factor.blocks[i]).second) marginalizer.eliminate(factor.blocks[i]);
		}
	}
	std::vector<double*> order;
	Eigen::MatrixXd information;
	if (!marginalizer.remainingInformation(order, information) || order.size() != wanted.size()) return false;
	const Eigen::LLT<Eigen::MatrixXd> llt(information);
	if (llt.info() != Eigen::Success) return false;
	const Eigen::MatrixXd inverse = llt.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));

	// From the order in which the factors named the blocks to the one asked for.
	std::unordered_map<const double*, Eigen::Index> place;
	Eigen::Index next = 0;
	for (const double* block : order)
	{
		place[block] = next;
		next += size[block];
	}
	covariance.resize(inverse.rows(), inverse.cols());
	Eigen::Index row = 0;
	for (const double* a : wanted)
	{
		Eigen::Index column = 0;
		for (const double* b : wanted)
		{
			covariance.block(row, column, size[a], size[b]) = inverse.block(place[a], place[b], size[a], size[b]);
			column += size[b];
		}
		row += size[a];
	}
	return true;
}

bool latestCovariance(Window& window, Eigen::Matrix<double, 15, 15>& covariance)
{
	Eigen::MatrixXd marginal;
	if (!marginalCovariance(window, {window.latest().pose.data(), window.latest().motion.data()}, marginal)) return false;
	covariance = marginal;
	return true;
}
}  // namespace viwo
