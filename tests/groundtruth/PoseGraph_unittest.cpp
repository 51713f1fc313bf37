#include "PoseGraph.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

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

TEST(PoseGraph, SelectedInverseIsTheDenseInverse)
{
	std::vector<Pose2> poses;
	auto edges = ring(12, poses);
	edges.push_back(edges[2]);
	edges.back().a = 2;
	edges.back().b = 9;
	edges.back().T_ab = between(poses[2], poses[9]);
	const auto covariances = graphCovariances(edges, poses);
	const size_t n = poses.size();
	Eigen::MatrixXd H = 1e-6 * Eigen::MatrixXd::Identity(static_cast<int>(3 * n), static_cast<int>(3 * n));
	for (const GraphEdge& e : edges)
	{
		// Numeric Jacobians of the relative pose.
		Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, static_cast<int>(3 * n));
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
		H += J.transpose() * e.information * J;
	}
	const int m = static_cast<int>(3 * (n - 1));
	const Eigen::MatrixXd dense = H.bottomRightCorner(m, m).inverse();
	EXPECT_TRUE(covariances[0].isZero());
	for (size_t i = 1; i < n; ++i)
	{
		const int at = static_cast<int>(3 * (i - 1));
		const Eigen::Matrix3d expected = dense.block(at, at, 3, 3);
		EXPECT_LT((covariances[i] - expected).norm(), 1e-5 * expected.norm()) << i;
	}
}
