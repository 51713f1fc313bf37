#include "PoseGraph.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <iostream>

using namespace viwo::gt;

namespace
{
std::vector<GraphEdge> ring(size_t n, std::vector<Pose2>& poses)
{
	std::vector<GraphEdge> edges;
	poses.clear();
	Pose2 T;
	for (size_t i = 0; i < n; ++i)
	{
		poses.push_back(T);
		T = T * Pose2(1, 0.1, 2 * M_PI / static_cast<double>(n));
	}
	for (size_t i = 0; i < n; ++i)
	{
		GraphEdge edge;
		edge.a = i;
		edge.b = (i + 1) % n;
		edge.T_ab = between(poses[edge.a], poses[edge.b]);
		edge.information = Eigen::Vector3d(100, 50, 400).asDiagonal();
		edge.information(0, 2) = edge.information(2, 0) = 20;
		edges.push_back(edge);
	}
	return edges;
}
}  // namespace

TEST(PoseGraph, ReturnsToTheExactPoses)
{
	std::vector<Pose2> truth;
	const auto edges = ring(20, truth);
	std::vector<Pose2> poses = truth;
	for (size_t i = 1; i < poses.size(); ++i) poses[i] = poses[i] * Pose2(0.1 * std::sin(static_cast<double>(i)), 0.05, 0.03);
	optimizeGraph(edges, poses, 50);
	for (size_t i = 0; i < poses.size(); ++i) EXPECT_LT((poses[i].p - truth[i].p).norm(), 1e-4);
}

TEST(PoseGraph, AWrongLoopWithAKernelDoesLittle)
{
	std::vector<Pose2> truth;
	auto edges = ring(20, truth);
	GraphEdge wrong = edges[0];
	wrong.a = 3;
	wrong.b = 13;
	wrong.T_ab = between(truth[3], truth[13]) * Pose2(2, 1, 0.5);
	wrong.information *= 100;
	wrong.kernel = 1;
	edges.push_back(wrong);
	std::vector<Pose2> poses = truth;
	optimizeGraph(edges, poses, 50);
	EXPECT_GT(chi2(edges.back(), poses), 1000);
	for (size_t i = 0; i < poses.size(); ++i) EXPECT_LT((poses[i].p - truth[i].p).norm(), 0.2);
}

namespace
{
/** Jacobian of the relative pose of an edge to all poses, numerically. */
Eigen::MatrixXd jacobianOf(const GraphEdge& e, const std::vector<Pose2>& poses, int columns)
{
	Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, columns);
	for (const size_t i : {e.a, e.b})
		for (int k = 0; k < 3; ++k)
		{
			const auto moved = [&](double h)
			{
				std::vector<Pose2> q = poses;
				if (k < 2)
					q[i].p[k] += h;
				else
					q[i].yaw += h;
				const Pose2 T = between(q[e.a], q[e.b]);
				return Eigen::Vector3d(T.p.x(), T.p.y(), wrapped(T.yaw - e.T_ab.yaw));
			};
			J.col(static_cast<int>(3 * i) + k) += (moved(1e-6) - moved(-1e-6)) / 2e-6;
		}
	return J;
}

/** A ring with an edge across it, every third edge by odometry, and turns by a gyroscope with three biases. */
struct Mixed
{
	std::vector<Pose2> poses;
	std::vector<GraphEdge> edges = ring(12, poses);
	GyroTurns gyro;
	CommonErrors common{0.02};

	Mixed()
	{
		edges.push_back(edges[2]);
		edges.back().a = 2;
		edges.back().b = 9;
		edges.back().T_ab = between(poses[2], poses[9]);
		for (size_t i = 0; i < edges.size(); i += 3) edges[i].kind = GraphEdge::Kind::odometry;
		for (size_t i = 0; i + 1 < poses.size(); ++i) gyro.turns.push_back({i, i + 1, 2 * M_PI / 12, 5, 200, i / 4});
		gyro.biases_rad_s.assign(3, 0);
		gyro.walk_rad_s = 0.004;
	}

	/** Of poses, biases and the scale, as they are defined. */
	Eigen::MatrixXd normalMatrix() const
	{
		const int n = static_cast<int>(3 * poses.size()), biases = 3, all = n + biases + 1;
		Eigen::MatrixXd H = Eigen::MatrixXd::Zero(all, all);
		H.diagonal().head(n).setConstant(1e-6);
		for (const GraphEdge& e : edges)
		{
			Eigen::MatrixXd J = jacobianOf(e, poses, all);
			if (e.kind == GraphEdge::Kind::odometry) J.col(all - 1).head<2>() = -e.T_ab.p;
			H += J.transpose() * informationOfMany(e) * J;
		}
		const auto addScalar = [&](std::initializer_list<std::pair<int, double>> row, double information)
		{
			Eigen::VectorXd J = Eigen::VectorXd::Zero(all);
			for (const auto& [column, value] : row) J[column] = value;
			H += information * J * J.transpose();
		};
		for (const GyroTurn& t : gyro.turns)
			addScalar({{static_cast<int>(3 * t.a) + 2, -1}, {static_cast<int>(3 * t.b) + 2, 1}, {n + static_cast<int>(t.bias), t.dt_s}},
			          t.information);
		addScalar({{n, 1}}, 1 / (kGyroBias_rad_s * kGyroBias_rad_s));
		for (int k = 1; k < biases; ++k) addScalar({{n + k - 1, -1}, {n + k, 1}}, 1 / (gyro.walk_rad_s * gyro.walk_rad_s));
		addScalar({{all - 1, 1}}, 1 / (common.odometry_scale * common.odometry_scale));
		return H;
	}
};
}  // namespace

TEST(PoseGraph, SelectedInverseIsTheDenseInverse)
{
	const Mixed graph;
	const auto covariances = graphCovariances(graph.edges, graph.poses, graph.gyro, graph.common);
	const Eigen::MatrixXd H = graph.normalMatrix();
	const auto m = H.rows() - 3;
	const Eigen::MatrixXd dense = H.bottomRightCorner(m, m).inverse();
	EXPECT_TRUE(covariances[0].isZero());
	for (size_t i = 1; i < graph.poses.size(); ++i)
	{
		const int at = static_cast<int>(3 * (i - 1));
		const Eigen::Matrix3d expected = dense.block(at, at, 3, 3);
		EXPECT_LT((covariances[i] - expected).norm(), 1e-5 * expected.norm()) << i;
	}
}

/** An unknown scale of odometry is one error on the whole way, not many small ones. */
TEST(PoseGraph, AScaleInCommonGrowsWithTheWay)
{
	std::vector<Pose2> poses;
	std::vector<GraphEdge> edges;
	for (size_t i = 0; i <= 100; ++i) poses.emplace_back(0.5 * static_cast<double>(i), 0, 0);
	for (size_t i = 0; i < 100; ++i)
	{
		GraphEdge edge;
		edge.a = i;
		edge.b = i + 1;
		edge.T_ab = Pose2(0.5, 0, 0);
		edge.information = Eigen::Vector3d(1e6, 1e6, 1e8).asDiagonal();
		edge.kind = GraphEdge::Kind::odometry;
		edges.push_back(edge);
	}
	EXPECT_NEAR(std::sqrt(graphCovariances(edges, poses)[100](0, 0)), 0.01, 1e-3);
	const auto covariances = graphCovariances(edges, poses, {}, {0.01});
	EXPECT_NEAR(std::sqrt(covariances[50](0, 0)), std::hypot(0.25, 0.00707), 1e-3);
	EXPECT_NEAR(std::sqrt(covariances[100](0, 0)), std::hypot(0.5, 0.01), 2e-3);
}

/** A corridor seen bent, by 0.1 deg a metre: registrations of neighbours near and far agree on it. The gyroscope knows better, once its
 * bias, which is unknown beforehand, has been found while the robot stands. */
TEST(PoseGraph, AGyroscopeStraightensABentCorridor)
{
	constexpr double kBend = 0.1 * M_PI / 180, kBias = 0.005;
	std::vector<Pose2> poses, bent;
	std::vector<GraphEdge> edges;
	GyroTurns gyro;
	for (size_t i = 0; i <= 60; ++i)
	{
		// It stands for the first 20 poses.
		const double x = i < 20 ? 0 : 0.3 * static_cast<double>(i - 20);
		poses.emplace_back(x, 0, 0);
		bent.emplace_back(x, 0.5 * kBend * x * x, kBend * x);
	}
	for (size_t i = 0; i < 60; ++i)
	{
		gyro.turns.push_back({i, i + 1, kBias * 2, 2, 1e6, 0});
		for (const size_t back : {1, 2, 3, 5, 8, 12})
		{
			if (i + 1 < back) continue;
			GraphEdge edge;
			edge.a = i + 1;
			edge.b = i + 1 - back;
			edge.T_ab = between(bent[edge.a], bent[edge.b]);
			edge.information = Eigen::Vector3d(1e3, 1e4, 1e6).asDiagonal();
			edges.push_back(edge);
		}
	}
	gyro.biases_rad_s = {0};
	std::vector<Pose2> with = bent, without = bent;
	optimizeGraph(edges, with, 50, &gyro);
	optimizeGraph(edges, without, 50);
	std::cout << "[measured] aside at the end " << without.back().p.y() << " m, with the gyroscope " << with.back().p.y() << " m, bias "
	          << gyro.biases_rad_s[0] << "\n";
	EXPECT_NEAR(without.back().p.y(), bent.back().p.y(), 0.01);
	EXPECT_LT(std::abs(with.back().p.y()), 0.3 * bent.back().p.y());
	EXPECT_NEAR(gyro.biases_rad_s[0], kBias, 2e-4);
	// Of the bend itself a registration says the less the longer the way; positive definite it stays.
	double last = 1e9;
	for (const GraphEdge& edge : {edges[0], edges[edges.size() - 6], edges.back()})
	{
		const Eigen::Matrix3d information = informationOfMany(edge);
		EXPECT_GT(Eigen::Matrix3d(information).llt().matrixL().determinant(), 0);
		const Eigen::Vector3d arc(-0.5 * edge.T_ab.p.y(), 0.5 * edge.T_ab.p.x(), 1);
		EXPECT_LT(arc.dot(information * arc), last);
		last = arc.dot(information * arc);
	}
}
