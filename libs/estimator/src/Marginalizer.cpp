#include "Marginalizer.h"

#include "residuals/BlockAlgebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace viwo
{
namespace
{
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/** Weighs a linearised residual by the derivative of the loss (Triggs et al., "Bundle adjustment: a modern synthesis", Sec. 4.3),
 *  with Ceres' rule: no second-order term where the loss curves downwards. */
class LossCorrection
{
   public:
	LossCorrection(const ceres::LossFunction& loss, const Eigen::Ref<const Eigen::VectorXd>& r) : squared_norm_(r.squaredNorm())
	{
		double rho[3];
		loss.Evaluate(squared_norm_, rho);
		root_ = std::sqrt(rho[1]);
		if (squared_norm_ > 0 && rho[2] > 0) alpha_ = 1 - std::sqrt(1 + 2 * squared_norm_ * rho[2] / rho[1]);
	}

	/** @param r the residual before its own correction. */
	void applyToJacobian(const Eigen::Ref<const Eigen::VectorXd>& r, Eigen::Map<RowMajorMatrix> J) const
	{
		if (alpha_ != 0)
		{
			const Eigen::RowVectorXd radial = r.transpose() * J;
			J -= (alpha_ / squared_norm_) * r * radial;
		}
		J *= root_;
	}
	void applyToResidual(Eigen::Map<Eigen::VectorXd>& r) const { r *= root_ / (1 - alpha_); }

   private:
	double squared_norm_, root_ = 1, alpha_ = 0;
};

/** A = diag(d) V diag(s) V^T diag(d) with d^2 the diagonal of A; only eigenvalues that count are kept. */
struct ScaledEigen
{
	ScaledEigen(const Eigen::MatrixXd& A, double relative_cut)
	{
		d = A.diagonal().unaryExpr([](double a) { return a > 0 ? std::sqrt(a) : 1.0; });
		const Eigen::VectorXd inverse = d.cwiseInverse();
		const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inverse.asDiagonal() * A * inverse.asDiagonal());
		const Eigen::VectorXd& values = solver.eigenvalues();
		const double least = relative_cut * values.cwiseAbs().maxCoeff();
		const Eigen::Index rank = (values.array() > least).count();
		s = values.tail(rank);
		V = solver.eigenvectors().rightCols(rank);
	}

	Eigen::VectorXd d, s;
	Eigen::MatrixXd V;
};
}  // namespace

void Marginalizer::add(Factor factor)
{
	factors_.push_back(std::move(factor));
}

void Marginalizer::eliminate(double* block)
{
	to_eliminate_[block] = true;
}

void Marginalizer::assemble()
{
	collectBlocks();
	freezeFactors();
	assignColumns();
	for (size_t i = 0; i < factors_.size(); ++i) accumulate(factors_[i], factor_blocks_[i]);
	eliminateLandmarks();
}

bool Marginalizer::remainingInformation(std::vector<double*>& blocks, Eigen::MatrixXd& information)
{
	assemble();
	// Eliminated columns come first, so the last rows of the Cholesky factor are that of the Schur complement.
	const Eigen::VectorXd scale = H_.diagonal().cwiseSqrt();
	if (!(scale.minCoeff() > 0)) return false;
	const Eigen::VectorXd inverse_scale = scale.cwiseInverse();
	const Eigen::LLT<Eigen::MatrixXd> llt(inverse_scale.asDiagonal() * H_ * inverse_scale.asDiagonal());
	if (llt.info() != Eigen::Success) return false;
	const int remaining = size_ - dense_size_;
	const Eigen::MatrixXd L = scale.tail(remaining).asDiagonal() * Eigen::MatrixXd(llt.matrixL()).bottomRightCorner(remaining, remaining);
	information = L * L.transpose();
	blocks.clear();
	for (const Block& block : blocks_)
		if (!block.eliminated) blocks.push_back(block.data);
	return true;
}

MarginalizationResult Marginalizer::run()
{
	assemble();
	eliminateDense();
	MarginalizationResult result;
	factorize(result);
	return result;
}

size_t Marginalizer::indexOf(double* data, const BlockShape& shape)
{
	const auto [entry, is_new] = index_.try_emplace(data, blocks_.size());
	if (is_new)
	{
		const bool eliminated = to_eliminate_.count(data) > 0;
		blocks_.push_back({data, shape, nullptr, eliminated, eliminated && shape.tangent == 1, 0});
	}
	return entry->second;
}

void Marginalizer::collectBlocks()
{
	for (const Factor& factor : factors_)
	{
		std::vector<size_t> ids, landmarks;
		for (size_t i = 0; i < factor.blocks.size(); ++i)
		{
			const size_t id = indexOf(factor.blocks[i], factor.cost->shapes()[i]);
			ids.push_back(id);
			if (blocks_[id].eliminated && blocks_[id].shape.tangent == 1) landmarks.push_back(id);
			if (!blocks_[id].x0) blocks_[id].x0 = factor.cost->linearizationPoint(static_cast<int>(i));
		}
		if (landmarks.size() > 1)
			for (const size_t id : landmarks) blocks_[id].landmark = false;
		factor_blocks_.push_back(std::move(ids));
	}
}

void Marginalizer::freezeFactors()
{
	// The points may belong to one of the costs: copied, lest a cost drops its own while it is being frozen anew.
	std::vector<std::vector<double>> points(blocks_.size());
	for (size_t id = 0; id < blocks_.size(); ++id)
		if (blocks_[id].x0) points[id].assign(blocks_[id].x0, blocks_[id].x0 + blocks_[id].shape.ambient);
	for (size_t f = 0; f < factors_.size(); ++f)
		for (size_t i = 0; i < factor_blocks_[f].size(); ++i)
		{
			const auto& point = points[factor_blocks_[f][i]];
			LocalCost& cost = *factors_[f].cost;
			const double* held = cost.linearizationPoint(static_cast<int>(i));
			if (!point.empty() && !(held && std::equal(point.begin(), point.end(), held))) cost.freeze(static_cast<int>(i), point.data());
		}
	for (size_t f = 0; f < factors_.size(); ++f)
		for (size_t i = 0; i < factor_blocks_[f].size(); ++i)
			blocks_[factor_blocks_[f][i]].x0 = factors_[f].cost->linearizationPoint(static_cast<int>(i));
}

void Marginalizer::assignColumns()
{
	int landmarks = 0;
	for (Block& block : blocks_)
		if (block.landmark) block.offset = landmarks++;
	for (const bool eliminated : {true, false})
	{
		for (Block& block : blocks_)
		{
			if (block.landmark || block.eliminated != eliminated) continue;
			block.offset = size_;
			size_ += block.shape.tangent;
		}
		if (eliminated) dense_size_ = size_;
	}
	H_ = Eigen::MatrixXd::Zero(size_, size_);
	g_ = Eigen::VectorXd::Zero(size_);
	landmark_H_ = Eigen::MatrixXd::Zero(size_, landmarks);
	landmark_h_ = landmark_g_ = Eigen::VectorXd::Zero(landmarks);
}

void Marginalizer::accumulate(const Factor& factor, const std::vector<size_t>& ids)
{
	// Some thousand small factors a frame: workspaces are kept, and products are evaluated in place (lazily), without temporaries.
	const Eigen::Index rows = factor.cost->num_residuals();
	Eigen::Index columns = 0;
	for (const size_t id : ids) columns += blocks_[id].shape.tangent;
	workspace_.resize(static_cast<size_t>(rows * (columns + 1)));
	pointers_.resize(ids.size());
	double* next = workspace_.data() + rows;
	for (size_t i = 0; i < ids.size(); ++i)
	{
		pointers_[i] = next;
		next += rows * blocks_[ids[i]].shape.tangent;
	}
	Eigen::Map<Eigen::VectorXd> r(workspace_.data(), rows);
	if (!factor.cost->linearize(factor.blocks.data(), r.data(), pointers_.data()))
	{
		++skipped_factors_;
		return;
	}
	const auto jacobian = [&](size_t i) { return Eigen::Map<RowMajorMatrix>(pointers_[i], rows, blocks_[ids[i]].shape.tangent); };
	if (factor.loss)
	{
		const LossCorrection correction(*factor.loss, r);
		for (size_t i = 0; i < ids.size(); ++i) correction.applyToJacobian(r, jacobian(i));
		correction.applyToResidual(r);
	}
	for (size_t i = 0; i < ids.size(); ++i)
	{
		const Block& a = blocks_[ids[i]];
		const auto Ja = jacobian(i);
		if (a.landmark)
		{
			landmark_h_[a.offset] += Ja.squaredNorm();
			landmark_g_[a.offset] += Ja.col(0).dot(r);
			continue;
		}
		g_.segment(a.offset, a.shape.tangent) += Ja.transpose().lazyProduct(r);
		for (size_t j = 0; j < ids.size(); ++j)
		{
			const Block& b = blocks_[ids[j]];
			const auto product = Ja.transpose().lazyProduct(jacobian(j));
			if (b.landmark)
				landmark_H_.col(b.offset).segment(a.offset, a.shape.tangent) += product;
			else
				H_.block(a.offset, b.offset, a.shape.tangent, b.shape.tangent) += product;
		}
	}
}

void Marginalizer::eliminateLandmarks()
{
	// Any positive h will do, however small: what is subtracted is bounded by what the same observations added.
	for (Eigen::Index k = 0; k < landmark_h_.size(); ++k)
	{
		if (!(landmark_h_[k] > std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon())) continue;
		const Eigen::VectorXd scaled = landmark_H_.col(k) / std::sqrt(landmark_h_[k]);
		H_.selfadjointView<Eigen::Lower>().rankUpdate(scaled, -1);
		g_ -= landmark_H_.col(k) * (landmark_g_[k] / landmark_h_[k]);
	}
	H_ = Eigen::MatrixXd(H_.selfadjointView<Eigen::Lower>());
}

void Marginalizer::eliminateDense()
{
	if (dense_size_ == 0) return;
	const int remaining = size_ - dense_size_;
	const ScaledEigen mm(H_.topLeftCorner(dense_size_, dense_size_), options_.relative_cut);
	// H_rm H_mm^-1 H_mr = Y^T Y, symmetric to the last bit.
	const Eigen::MatrixXd root = mm.s.cwiseSqrt().cwiseInverse().asDiagonal() * mm.V.transpose() * mm.d.cwiseInverse().asDiagonal();
	const Eigen::MatrixXd Y = root * H_.topRightCorner(dense_size_, remaining);
	const Eigen::VectorXd y = root * g_.head(dense_size_);
	H_ = (H_.bottomRightCorner(remaining, remaining) - Y.transpose() * Y).eval();
	H_ = (0.5 * (H_ + H_.transpose())).eval();
	g_ = (g_.tail(remaining) - Y.transpose() * y).eval();
}

void Marginalizer::factorize(MarginalizationResult& result) const
{
	result.skipped_factors = skipped_factors_;
	Eigen::VectorXd deviation(H_.cols());
	Eigen::Index column = 0;
	for (const Block& block : blocks_)
	{
		if (block.eliminated) continue;
		const double* x0 = block.x0 ? block.x0 : block.data;
		result.blocks.push_back(block.data);
		result.shapes.push_back(block.shape);
		result.x0.emplace_back(x0, x0 + block.shape.ambient);
		blockMinus(block.shape, block.data, x0, deviation.data() + column);
		column += block.shape.tangent;
	}
	if (H_.cols() == 0) return;
	const ScaledEigen root(H_, options_.relative_cut);
	const Eigen::VectorXd sqrt_s = root.s.cwiseSqrt();
	result.J0 = sqrt_s.asDiagonal() * root.V.transpose() * root.d.asDiagonal();
	const Eigen::VectorXd r = sqrt_s.cwiseInverse().asDiagonal() * root.V.transpose() * root.d.cwiseInverse().asDiagonal() * g_;
	result.r0 = r - result.J0 * deviation;  // r is the residual at the present state, r0 the one at x0
}
}  // namespace viwo
