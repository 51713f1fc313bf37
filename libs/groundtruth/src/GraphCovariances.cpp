#include "PoseGraph.h"

#include <viwo/core/Scalars.h>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>

namespace viwo::gt
{
namespace
{
using Sparse = Eigen::SparseMatrix<double>;

/** J^T W J of all edges without the first pose; behind the poses the gyroscope's biases and the scale of odometry. */
class NormalMatrix
{
   public:
	NormalMatrix(const std::vector<GraphEdge>& edges, const std::vector<Pose2>& poses, const GyroTurns& gyro, const CommonErrors& common)
	    : poses_(poses), bias_(static_cast<int>(3 * (poses.size() - 1))), scale_(bias_ + static_cast<int>(gyro.biases_rad_s.size()))
	{
		for (const GraphEdge& edge : edges) add(edge, common);
		for (const GyroTurn& turn : gyro.turns) add(turn);
		if (scale_ > bias_) triplets_.emplace_back(bias_, bias_, 1 / square(kGyroBias_rad_s));
		for (int k = bias_ + 1; k < scale_; ++k) addDifference(k - 1, k, 1 / square(gyro.walk_rad_s));
		// A pose without any edge gets a huge variance instead of a division by zero.
		for (int i = 0; i < bias_; ++i) triplets_.emplace_back(i, i, 1e-6);
		triplets_.emplace_back(scale_, scale_, common.odometry_scale > 0 ? 1 / square(common.odometry_scale) : 1);
	}

	Sparse matrix() const
	{
		Sparse H(scale_ + 1, scale_ + 1);
		H.setFromTriplets(triplets_.begin(), triplets_.end());
		return H;
	}

   private:
	static int columnOf(size_t pose) { return static_cast<int>(3 * pose) - 3; }

	/** A block, and its transpose where it is off the diagonal. */
	template <class Block>
	void put(int row, int column, const Block& block)
	{
		if (row < 0 || column < 0) return;
		for (int r = 0; r < block.rows(); ++r)
			for (int c = 0; c < block.cols(); ++c)
			{
				triplets_.emplace_back(row + r, column + c, block(r, c));
				if (row != column) triplets_.emplace_back(column + c, row + r, block(r, c));
			}
	}

	void add(const GraphEdge& edge, const CommonErrors& common)
	{
		const Pose2 T = between(poses_[edge.a], poses_[edge.b]);
		const double c = std::cos(poses_[edge.a].yaw), s = std::sin(poses_[edge.a].yaw);
		Eigen::Matrix3d A, B;
		A << -c, -s, T.p.y(), s, -c, -T.p.x(), 0, 0, -1;
		B << c, s, 0, -s, c, 0, 0, 0, 1;
		// Cauchy's weight: rho'(s) = 1 / (1 + s / kernel^2).
		const double weight = edge.kernel > 0 ? 1 / (1 + chi2(edge, poses_) / (edge.kernel * edge.kernel)) : 1;
		const Eigen::Matrix3d W = weight * informationOfMany(edge);
		const int a = columnOf(edge.a), b = columnOf(edge.b);
		put<Eigen::Matrix3d>(a, a, A.transpose() * W * A);
		put<Eigen::Matrix3d>(a, b, A.transpose() * W * B);
		put<Eigen::Matrix3d>(b, b, B.transpose() * W * B);
		if (edge.kind != GraphEdge::Kind::odometry || common.odometry_scale <= 0) return;
		const Eigen::Vector3d S(-edge.T_ab.p.x(), -edge.T_ab.p.y(), 0);
		put<Eigen::Vector3d>(a, scale_, A.transpose() * W * S);
		put<Eigen::Vector3d>(b, scale_, B.transpose() * W * S);
		triplets_.emplace_back(scale_, scale_, S.dot(W * S));
	}

	/** Of two scalars. */
	void addDifference(int a, int b, double information)
	{
		triplets_.emplace_back(b, b, information);
		if (a < 0) return;
		triplets_.emplace_back(a, a, information);
		triplets_.emplace_back(a, b, -information);
		triplets_.emplace_back(b, a, -information);
	}

	void add(const GyroTurn& turn)
	{
		const int a = columnOf(turn.a) + 2, b = columnOf(turn.b) + 2, bias = bias_ + static_cast<int>(turn.bias);
		addDifference(turn.a > 0 ? a : -1, b, turn.information);
		const Eigen::Matrix<double, 1, 1> coupling(turn.information * turn.dt_s);
		if (turn.a > 0) put(a, bias, Eigen::Matrix<double, 1, 1>(-coupling));
		put(b, bias, coupling);
		put(bias, bias, Eigen::Matrix<double, 1, 1>(coupling * turn.dt_s));
	}

	const std::vector<Pose2>& poses_;
	const int bias_, scale_;
	std::vector<Eigen::Triplet<double>> triplets_;
};

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

std::vector<Eigen::Matrix3d> graphCovariances(const std::vector<GraphEdge>& edges, const std::vector<Pose2>& poses, const GyroTurns& gyro,
                                              const CommonErrors& common)
{
	std::vector<Eigen::Matrix3d> covariances(poses.size(), Eigen::Matrix3d::Zero());
	if (poses.size() < 2) return covariances;
	const Eigen::SimplicialLDLT<Sparse> ldlt(NormalMatrix(edges, poses, gyro, common).matrix());
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
