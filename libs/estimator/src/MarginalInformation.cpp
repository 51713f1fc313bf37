#include "MarginalInformation.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace viwo
{
namespace
{
struct NormalEquations
{
	explicit NormalEquations(const FactorSet& factors)
	    : H(Eigen::MatrixXd::Zero(factors.columns(), factors.columns())),
	      landmark_H(Eigen::MatrixXd::Zero(factors.columns(), factors.landmarks())),
	      landmark_h(Eigen::VectorXd::Zero(factors.landmarks()))
	{
	}

	/** Adds the factor that was linearised last. Small products are evaluated in place (lazily), without temporaries. */
	void add(const FactorSet& factors, size_t factor)
	{
		const std::vector<size_t>& ids = factors.blocksOf(factor);
		for (size_t i = 0; i < ids.size(); ++i)
		{
			const FactorSet::Block& a = factors.blocks()[ids[i]];
			const auto J_a = factors.jacobian(i);
			if (a.landmark)
			{
				landmark_h[a.column] += J_a.squaredNorm();
				continue;
			}
			for (size_t j = 0; j < ids.size(); ++j)
			{
				const FactorSet::Block& b = factors.blocks()[ids[j]];
				const auto product = J_a.transpose().lazyProduct(factors.jacobian(j));
				if (b.landmark)
					landmark_H.col(b.column).segment(a.column, a.shape.tangent) += product;
				else
					H.block(a.column, b.column, a.shape.tangent, b.shape.tangent) += product;
			}
		}
	}

	/** All landmarks in one product. Any positive h will do, however small: what is subtracted is bounded by what the same observations
	 * added. */
	void eliminateLandmarks()
	{
		if (landmark_h.size() == 0) return;  // Eigen divides by the number of columns
		const double least = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
		const Eigen::VectorXd root = landmark_h.unaryExpr([&](double h) { return h > least ? 1 / std::sqrt(h) : 0.0; });
		landmark_H = landmark_H * root.asDiagonal();
		H.selfadjointView<Eigen::Lower>().rankUpdate(landmark_H, -1);
		H = Eigen::MatrixXd(H.selfadjointView<Eigen::Lower>());
	}

	Eigen::MatrixXd H;
	Eigen::MatrixXd landmark_H;  //!< column k: coupling of landmark k
	Eigen::VectorXd landmark_h;
};
}  // namespace

bool marginalInformation(FactorSet& factors, Eigen::MatrixXd& information)
{
	NormalEquations equations(factors);
	for (size_t f = 0; f < factors.size(); ++f)
		if (factors.linearize(f)) equations.add(factors, f);
	equations.eliminateLandmarks();

	// Eliminated columns come first, so the last rows of the Cholesky factor are that of the Schur complement.
	const int remaining = factors.columns() - factors.eliminatedColumns();
	const Eigen::VectorXd scale = equations.H.diagonal().cwiseSqrt();
	if (!(scale.minCoeff() > 0)) return false;
	const Eigen::VectorXd inverse_scale = scale.cwiseInverse();
	const Eigen::LLT<Eigen::MatrixXd> llt(inverse_scale.asDiagonal() * equations.H * inverse_scale.asDiagonal());
	if (llt.info() != Eigen::Success) return false;
	const Eigen::MatrixXd L = scale.tail(remaining).asDiagonal() * Eigen::MatrixXd(llt.matrixL()).bottomRightCorner(remaining, remaining);
	information = L * L.transpose();
	return true;
}
}  // namespace viwo
