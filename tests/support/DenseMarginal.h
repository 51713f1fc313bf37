#pragma once

#include <Marginalizer.h>
#include <NumericJacobian.h>
#include <SyntheticWindow.h>

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <vector>

/** What marginalisation should give, the slow way. */
namespace viwo::test
{
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/** Normal equations of a set of factors over the given blocks, dense and in extended precision. */
struct DenseSystem
{
	DenseSystem(const std::vector<Factor>& factors, const std::vector<double*>& order)
	{
		std::map<double*, int> offset;
		std::map<double*, BlockShape> shape;
		for (const Factor& f : factors)
			for (size_t i = 0; i < f.blocks.size(); ++i) shape[f.blocks[i]] = f.cost->shapes()[i];
		int size = 0;
		for (double* block : order)
		{
			offset[block] = size;
			size += shape.at(block).tangent;
		}
		H = LongMatrix::Zero(size, size);
		g = LongVector::Zero(size);
		for (const Factor& f : factors) add(f, offset);
	}

	void add(const Factor& f, const std::map<double*, int>& offset)
	{
		LongMatrix J = LongMatrix::Zero(f.cost->num_residuals(), g.size());
		std::vector<RowMajor> local;
		std::vector<double*> p;
		for (const BlockShape& s : f.cost->shapes()) local.emplace_back(f.cost->num_residuals(), s.tangent);
		for (auto& l : local) p.push_back(l.data());
		Eigen::VectorXd r(f.cost->num_residuals());
		ASSERT_TRUE(f.cost->linearize(f.blocks.data(), r.data(), p.data()));
		for (size_t i = 0; i < local.size(); ++i) J.middleCols(offset.at(f.blocks[i]), local[i].cols()) += local[i].cast<long double>();
		H += J.transpose() * J;
		g += J.transpose() * r.cast<long double>();
	}

	/** Schur complement of all but the first m columns. */
	void eliminateFirst(Eigen::Index m)
	{
		const Eigen::Index n = g.size() - m;
		const LongMatrix K = H.topLeftCorner(m, m).fullPivLu().solve(H.topRightCorner(m, n));
		g = (g.tail(n) - K.transpose() * g.head(m)).eval();
		H = (H.bottomRightCorner(n, n) - H.bottomLeftCorner(n, m) * K).eval();
	}

	LongMatrix H;
	LongVector g;
};

/** Normal equations as Ceres itself assembles them, losses applied, through PoseManifold. */
inline DenseSystem ceresSystem(const std::vector<Factor>& factors, const std::vector<double*>& order)
{
	DenseSystem system({}, {});
	ceres::Problem::Options options;
	options.cost_function_ownership = options.loss_function_ownership = options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	ceres::Problem problem(options);
	PoseManifold pose;
	for (const Factor& f : factors)
	{
		problem.AddResidualBlock(f.cost.get(), f.loss.get(), f.blocks);
		for (size_t i = 0; i < f.blocks.size(); ++i)
			if (f.cost->shapes()[i].kind == BlockKind::pose) problem.SetManifold(f.blocks[i], &pose);
	}
	ceres::Problem::EvaluateOptions evaluate;
	evaluate.parameter_blocks = order;
	std::vector<double> r;
	ceres::CRSMatrix crs;
	problem.Evaluate(evaluate, nullptr, &r, nullptr, &crs);
	LongMatrix J = LongMatrix::Zero(crs.num_rows, crs.num_cols);
	for (int row = 0; row < crs.num_rows; ++row)
		for (int k = crs.rows[size_t(row)]; k < crs.rows[size_t(row) + 1]; ++k) J(row, crs.cols[size_t(k)]) = crs.values[size_t(k)];
	system.H = J.transpose() * J;
	system.g = J.transpose() * Eigen::Map<Eigen::VectorXd>(r.data(), Eigen::Index(r.size())).cast<long double>();
	return system;
}

inline Marginalizer makeMarginalizer(const std::vector<Factor>& factors, const std::vector<double*>& eliminated)
{
	Marginalizer marginalizer;
	for (const Factor& f : factors) marginalizer.add(f);
	for (double* block : eliminated) marginalizer.eliminate(block);
	return marginalizer;
}

/** Relative error of J0^T J0 and of the gradient at the present state, in units of the diagonal. */
inline double errorOf(const MarginalizationResult& result, const DenseSystem& reference)
{
	const auto cost = result.makeCost();
	Eigen::VectorXd r(result.r0.size());
	std::vector<const double*> x(result.blocks.begin(), result.blocks.end());
	cost->evaluateLocal(x.data(), r.data(), nullptr);
	const LongMatrix J0 = result.J0.cast<long double>();
	const LongVector scale = reference.H.diagonal().cwiseSqrt().cwiseInverse();
	const LongMatrix dH = scale.asDiagonal() * (J0.transpose() * J0 - reference.H) * scale.asDiagonal();
	const LongVector dg = scale.asDiagonal() * (J0.transpose() * r.cast<long double>() - reference.g);
	const LongVector g = scale.asDiagonal() * reference.g;
	return double(std::max(dH.cwiseAbs().maxCoeff(), dg.norm() / g.norm()));
}

inline int tangentSize(const std::vector<double*>& blocks, const std::vector<Factor>& factors)
{
	int size = 0;
	for (double* block : blocks)
	{
		int own = 0;
		for (const Factor& f : factors)
			for (size_t i = 0; i < f.blocks.size(); ++i)
				if (f.blocks[i] == block) own = f.cost->shapes()[i].tangent;
		size += own;
	}
	return size;
}

inline std::vector<double*> concatenate(std::vector<double*> a, const std::vector<double*>& b)
{
	a.insert(a.end(), b.begin(), b.end());
	return a;
}

inline std::vector<double*> oldestOf(SyntheticWindow& window, int k)
{
	return concatenate({window.poses[size_t(k)].data(), window.motions[size_t(k)].data()}, window.landmarksOf(k));
}
}  // namespace viwo::test
