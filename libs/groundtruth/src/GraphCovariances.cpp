#include "PoseGraph.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>

namespace viwo::gt
{
namespace
{
using Sparse = Eigen::SparseMatrix<double>;

/** J^T W J of all edges without the first pose. */
Sparse normalMatrix(const std::vector<GraphEdge>& edges, const std::vector<Pose2>& poses)
{
	std::vector<Eigen::Triplet<double>> triplets;
	const auto add = [&](size_t row, size_t column, const Eigen::Matrix3d& block)
	{
		if (row == 0 || column == 0) return;
		for (int r = 0; r < 3; ++r)
			for (int c = 0; c < 3; ++c)
				triplets.emplace_back(static_cast<int>(3 * (row - 1)) + r, static_cast<int>(3 * (column - 1)) + c, block(r, c));
	};
	for (const GraphEdge& edge : edges)
	{
		const Pose2 T = between(poses[edge.a], poses[edge.b]);
		const double c = std::cos(poses[edge.a].yaw), s = std::sin(poses[edge.a].yaw);
		Eigen::Matrix3d A, B;
		A << -c, -s, T.p.y(), s, -c, -T.p.x(), 0, 0, -1;
		B << c, s, 0, -s, c, 0, 0, 0, 1;
		// Cauchy's weight: rho'(s) = 1 / (1 + s / kernel^2).
		const double weight = edge.kernel > 0 ? 1 / (1 + chi2(edge, poses) / (edge.kernel * edge.kernel)) : 1;
		const Eigen::Matrix3d W = weight * edge.information;
		add(edge.a, edge.a, A.transpose() * W * A);
		add(edge.a, edge.b, A.transpose() * W * B);
		add(edge.b, edge.a, B.transpose() * W * A);
		add(edge.b, edge.b, B.transpose() * W * B);
	}
	const int n = static_cast<int>(3 * (poses.size() - 1));
	// A pose without any edge gets a huge variance instead of a division by zero.
	for (int i = 0; i < n; ++i) triplets.emplace_back(i, i, 1e-6);
	Sparse H(n, n);
	H.setFromTriplets(triplets.begin(), triplets.end());
	return H;
}

/** Entries of (L D L^T)^-1 on the pattern of L, column by column from the last. */
class SelectedInverse
{
   public:
	SelectedInverse(const Sparse& L, const Eigen::VectorXd& D) : Z_(L)
	{
		for (int j = static_cast<int>(L.cols()) - 1; j >= 0; --j) column(L, D, j);
	}

	double at(int row, int column) const
	{
		if (row < column) std::swap(row, column);
		const int* begin = Z_.innerIndexPtr() + Z_.outerIndexPtr()[column];
		const int* end = Z_.innerIndexPtr() + Z_.outerIndexPtr()[column + 1];
		const int* found = std::lower_bound(begin, end, row);
		return found != end && *found == row ? Z_.valuePtr()[found - Z_.innerIndexPtr()] : 0;
	}

   private:
	void column(const Sparse& L, const Eigen::VectorXd& D, int j)
	{
		const int begin = L.outerIndexPtr()[j], end = L.outerIndexPtr()[j + 1];
		std::vector<std::pair<int, double>> below;  // of L's column, without the unit diagonal
		for (int k = begin; k < end; ++k)
			if (L.innerIndexPtr()[k] > j) below.emplace_back(L.innerIndexPtr()[k], L.valuePtr()[k]);
		// The products need Z at all pairs of `below`; filling stops there because L's pattern is closed under elimination.
		std::vector<double> z(below.size(), 0);
		for (size_t a = 0; a < below.size(); ++a)
		{
			const int row = below[a].first;
			const int* cursor = Z_.innerIndexPtr() + Z_.outerIndexPtr()[row];
			const int* last = Z_.innerIndexPtr() + Z_.outerIndexPtr()[row + 1];
			for (size_t b = a; b < below.size(); ++b)
			{
				while (cursor != last && *cursor < below[b].first) ++cursor;
				if (cursor == last || *cursor != below[b].first) continue;
				const double value = Z_.valuePtr()[cursor - Z_.innerIndexPtr()];
				z[a] -= value * below[b].second;
				if (a != b) z[b] -= value * below[a].second;
			}
		}
		double diagonal = 1 / D[j];
		for (size_t a = 0; a < below.size(); ++a) diagonal -= below[a].second * z[a];
		size_t a = 0;
		for (int k = begin; k < end; ++k)
			if (L.innerIndexPtr()[k] > j)
				Z_.valuePtr()[k] = z[a++];
			else if (L.innerIndexPtr()[k] == j)
				Z_.valuePtr()[k] = diagonal;
	}

	Sparse Z_;
};
}  // namespace

std::vector<Eigen::Matrix3d> graphCovariances(const std::vector<GraphEdge>& edges, const std::vector<Pose2>& poses)
{
	std::vector<Eigen::Matrix3d> covariances(poses.size(), Eigen::Matrix3d::Zero());
	if (poses.size() < 2) return covariances;
	const Eigen::SimplicialLDLT<Sparse> ldlt(normalMatrix(edges, poses));
	// Eigen's L leaves out its unit diagonal: add it so that the inverse has a place for its own.
	Sparse L = ldlt.matrixL();
	Sparse unit(L.rows(), L.cols());
	unit.setIdentity();
	Sparse strict = L.triangularView<Eigen::StrictlyLower>();
	const Sparse whole = strict + unit;
	const SelectedInverse inverse(whole, ldlt.vectorD());
	const auto& order = ldlt.permutationP().indices();
	for (size_t i = 1; i < poses.size(); ++i)
		for (int r = 0; r < 3; ++r)
			for (int c = 0; c < 3; ++c)
			{
				const int base = static_cast<int>(3 * (i - 1));
				covariances[i](r, c) = inverse.at(order[base + r], order[base + c]);
			}
	return covariances;
}
}  // namespace viwo::gt
