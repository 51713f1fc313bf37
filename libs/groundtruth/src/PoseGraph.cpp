#include "PoseGraph.h"

#include <ceres/ceres.h>
#include <viwo/core/Scalars.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace viwo::gt
{
namespace
{
constexpr double kGyroKernel = 5;
constexpr double kLeastShare = 0.05;  // of the information in the weaker direction
/** rad per square root of a metre, of one registration of many. Walls on all sides outweigh each other's bends, those of a corridor do not.
 */
constexpr double kBendInCorridor = 2.5 * kDegree, kBendInRoom = 0.25 * kDegree;
constexpr double kAllRound = 0.3;  // share of the weaker direction from which on walls are on all sides

/** Of the information on the position, what is in the weaker direction. */
double weakestShare(const GraphEdge& edge)
{
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
	solver.computeDirect(edge.information.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
	return solver.eigenvalues()[0] / std::max(solver.eigenvalues().sum(), 1e-12);
}

/** e = L^T [R_a^T (p_b - p_a) - p_ab; yaw_b - yaw_a - yaw_ab], information = L L^T. */
class RelativePose2Residual : public ceres::SizedCostFunction<3, 3, 3>
{
   public:
	RelativePose2Residual(const Pose2& T_ab, const Eigen::Matrix3d& information) : T_ab_(T_ab), root_(information.llt().matrixU()) {}

	bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override
	{
		const Eigen::Vector2d d(x[1][0] - x[0][0], x[1][1] - x[0][1]);
		const double c = std::cos(x[0][2]), s = std::sin(x[0][2]);
		const Eigen::Vector2d in_a(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
		Eigen::Map<Eigen::Vector3d> e(residuals);
		e << in_a - T_ab_.p, wrapped(x[1][2] - x[0][2] - T_ab_.yaw);
		e = root_ * e;
		if (!jacobians) return true;
		using Jacobian = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
		if (jacobians[0])
		{
			Eigen::Matrix3d J;
			J << -c, -s, in_a.y(), s, -c, -in_a.x(), 0, 0, -1;
			Eigen::Map<Jacobian>(jacobians[0], 3, 3) = root_ * J;
		}
		if (jacobians[1])
		{
			Eigen::Matrix3d J;
			J << c, s, 0, -s, c, 0, 0, 0, 1;
			Eigen::Map<Jacobian>(jacobians[1], 3, 3) = root_ * J;
		}
		return true;
	}

   private:
	Pose2 T_ab_;
	Eigen::Matrix3d root_;
};

/** e = root (yaw_b - yaw_a + bias dt - turn). */
class GyroTurnResidual : public ceres::SizedCostFunction<1, 3, 3, 1>
{
   public:
	explicit GyroTurnResidual(const GyroTurn& turn) : turn_(turn), root_(std::sqrt(turn.information)) {}

	bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override
	{
		residuals[0] = root_ * wrapped(x[1][2] - x[0][2] + x[2][0] * turn_.dt_s - turn_.turn_rad);
		if (!jacobians) return true;
		if (jacobians[0]) Eigen::Map<Eigen::RowVector3d>(jacobians[0]) << 0, 0, -root_;
		if (jacobians[1]) Eigen::Map<Eigen::RowVector3d>(jacobians[1]) << 0, 0, root_;
		if (jacobians[2]) jacobians[2][0] = root_ * turn_.dt_s;
		return true;
	}

   private:
	GyroTurn turn_;
	double root_;
};

/** Of the first bias, around zero. */
class BiasPrior : public ceres::SizedCostFunction<1, 1>
{
   public:
	bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override
	{
		residuals[0] = x[0][0] / kGyroBias_rad_s;
		if (jacobians && jacobians[0]) jacobians[0][0] = 1 / kGyroBias_rad_s;
		return true;
	}
};

/** From one bias to the next. */
class BiasWalk : public ceres::SizedCostFunction<1, 1, 1>
{
   public:
	explicit BiasWalk(double deviation_rad_s) : root_(1 / deviation_rad_s) {}

	bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override
	{
		residuals[0] = root_ * (x[1][0] - x[0][0]);
		if (jacobians && jacobians[0]) jacobians[0][0] = -root_;
		if (jacobians && jacobians[1]) jacobians[1][0] = root_;
		return true;
	}

   private:
	double root_;
};

void addGyro(GyroTurns& gyro, std::vector<Eigen::Vector3d>& x, ceres::Problem& problem)
{
	std::vector<double>& biases = gyro.biases_rad_s;
	for (const GyroTurn& turn : gyro.turns)
		problem.AddResidualBlock(new GyroTurnResidual(turn), new ceres::CauchyLoss(kGyroKernel), x[turn.a].data(), x[turn.b].data(),
		                         &biases[turn.bias]);
	problem.AddResidualBlock(new BiasPrior, nullptr, &biases.front());
	for (size_t k = 1; k < biases.size(); ++k) problem.AddResidualBlock(new BiasWalk(gyro.walk_rad_s), nullptr, &biases[k - 1], &biases[k]);
}
}  // namespace

Eigen::Matrix3d informationOfMany(const GraphEdge& edge)
{
	if (edge.kind == GraphEdge::Kind::odometry) return edge.information;
	const double corridor = 1 - std::min(1.0, weakestShare(edge) / kAllRound);
	const double bend = kBendInRoom + corridor * (kBendInCorridor - kBendInRoom);
	const double variance = square(bend) * edge.T_ab.p.norm();
	// Who goes along an arc instead of a line ends up turned by the whole angle, and aside by the half of it.
	const Eigen::Vector3d arc(-0.5 * edge.T_ab.p.y(), 0.5 * edge.T_ab.p.x(), 1);
	// Woodbury's identity: the covariance, which may not exist, plus that of the bend.
	const Eigen::Vector3d column = edge.information * arc;
	return edge.information - column * column.transpose() * (variance / (1 + variance * arc.dot(column)));
}

double chi2(const GraphEdge& edge, const std::vector<Pose2>& poses)
{
	const Pose2 T = between(poses[edge.a], poses[edge.b]);
	const Eigen::Vector3d e(T.p.x() - edge.T_ab.p.x(), T.p.y() - edge.T_ab.p.y(), wrapped(T.yaw - edge.T_ab.yaw));
	return e.dot(edge.information * e);
}

bool holdsAllDirections(const GraphEdge& edge)
{
	return weakestShare(edge) >= kLeastShare;
}

double optimizeGraph(const std::vector<GraphEdge>& edges, std::vector<Pose2>& poses, int iterations, GyroTurns* gyro)
{
	if (poses.size() < 2 || edges.empty()) return 0;
	std::vector<Eigen::Vector3d> x;
	for (const Pose2& T : poses) x.emplace_back(T.p.x(), T.p.y(), T.yaw);
	ceres::Problem problem;
	const bool with_gyro = gyro && !gyro->turns.empty();
	for (const GraphEdge& edge : edges)
		problem.AddResidualBlock(new RelativePose2Residual(edge.T_ab, with_gyro ? informationOfMany(edge) : edge.information),
		                         edge.kernel > 0 ? new ceres::CauchyLoss(edge.kernel) : nullptr, x[edge.a].data(), x[edge.b].data());
	if (with_gyro) addGyro(*gyro, x, problem);
	if (problem.HasParameterBlock(x[0].data())) problem.SetParameterBlockConstant(x[0].data());
	ceres::Solver::Options options;
	options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
	options.max_num_iterations = iterations;
	options.function_tolerance = 1e-5;
	options.num_threads = 1;
	options.logging_type = ceres::SILENT;
	ceres::Solver::Summary summary;
	ceres::Solve(options, &problem, &summary);
	for (size_t i = 0; i < poses.size(); ++i) poses[i] = Pose2(x[i].x(), x[i].y(), wrapped(x[i].z()));
	return summary.final_cost;
}
}  // namespace viwo::gt
