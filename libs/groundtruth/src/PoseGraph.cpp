#include "PoseGraph.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace viwo::gt
{
namespace
{
/** e = L^T [R_a^T (p_b - p_a) - p_ab; yaw_b - yaw_a - yaw_ab], information = L L^T. */
class RelativePose2Residual : public ceres::SizedCostFunction<3, 3, 3>
{
   public:
	explicit RelativePose2Residual(const GraphEdge& edge) : T_ab_(edge.T_ab), root_(edge.information.llt().matrixU()) {}

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
}  // namespace

double chi2(const GraphEdge& edge, const std::vector<Pose2>& poses)
{
	const Pose2 T = between(poses[edge.a], poses[edge.b]);
	const Eigen::Vector3d e(T.p.x() - edge.T_ab.p.x(), T.p.y() - edge.T_ab.p.y(), wrapped(T.yaw - edge.T_ab.yaw));
	return e.dot(edge.information * e);
}

bool holdsAllDirections(const GraphEdge& edge)
{
	constexpr double kLeastShare = 0.05;  // of the information in the weaker direction
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
	solver.computeDirect(edge.information.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
	return solver.eigenvalues()[0] >= kLeastShare * solver.eigenvalues().sum();
}

double optimizeGraph(const std::vector<GraphEdge>& edges, std::vector<Pose2>& poses, int iterations)
{
	if (poses.size() < 2 || edges.empty()) return 0;
	std::vector<Eigen::Vector3d> x;
	for (const Pose2& T : poses) x.emplace_back(T.p.x(), T.p.y(), T.yaw);
	ceres::Problem problem;
	for (const GraphEdge& edge : edges)
		problem.AddResidualBlock(new RelativePose2Residual(edge), edge.kernel > 0 ? new ceres::CauchyLoss(edge.kernel) : nullptr,
		                         x[edge.a].data(), x[edge.b].data());
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
