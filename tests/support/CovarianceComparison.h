#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <random>

namespace viwo::test
{
/** Independent errors of zero mean and unit variance, fast: sums of four uniform numbers. Near enough to Gaussian where only second moments
 * count. */
class UnitErrors
{
   public:
	explicit UnitErrors(uint64_t seed) : generator_(seed) {}
	double operator()()
	{
		const uint64_t bits = generator_();
		const double sum = static_cast<double>((bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48));
		return (sum - 2. * 65535) * std::sqrt(3 / (65536. * 65536 - 1));
	}
	Eigen::Vector3d vector3()
	{
		const double x = (*this)(), y = (*this)();
		return {x, y, (*this)()};
	}

   private:
	std::mt19937_64 generator_;
};

/** Second moment of error vectors, drawn one by one. */
template <int N>
class SampleCovariance
{
   public:
	void add(const Eigen::Matrix<double, N, 1>& error)
	{
		sum_ += error * error.transpose();
		++count_;
	}
	Eigen::Matrix<double, N, N> value() const { return sum_ / static_cast<double>(count_); }

   private:
	Eigen::Matrix<double, N, N> sum_ = Eigen::Matrix<double, N, N>::Zero();
	int64_t count_ = 0;
};

/** Largest relative differences of two covariances that are made of 3x3 blocks. */
struct CovarianceDifference
{
	double diagonal_entry = 0;  //!< |model / drawn - 1|
	double diagonal_block = 0;  //!< Frobenius norm of the difference over that of the drawn block
	/** The same where the block's norm is at least a fifth of sqrt(product of its two diagonal blocks' norms), which is its largest
	 * possible size. A smaller one is lost in the sampling error: there the difference is taken relative to that largest size.
	 */
	double cross_block = 0;
	int significant_cross_blocks = 0;

	double worst() const { return std::max({diagonal_entry, diagonal_block, cross_block}); }
};

template <int N>
CovarianceDifference compareCovariances(const Eigen::Matrix<double, N, N>& model, const Eigen::Matrix<double, N, N>& drawn)
{
	CovarianceDifference result;
	for (int i = 0; i < N; ++i) result.diagonal_entry = std::max(result.diagonal_entry, std::abs(model(i, i) / drawn(i, i) - 1));
	for (int r = 0; r < N; r += 3)
	{
		for (int c = r; c < N; c += 3)
		{
			const Eigen::Matrix3d block = drawn.template block<3, 3>(r, c);
			const double difference = (model.template block<3, 3>(r, c) - block).norm();
			if (r == c)
			{
				result.diagonal_block = std::max(result.diagonal_block, difference / block.norm());
				continue;
			}
			const double largest = std::sqrt(drawn.template block<3, 3>(r, r).norm() * drawn.template block<3, 3>(c, c).norm());
			const bool significant = block.norm() >= 0.2 * largest;
			if (significant) ++result.significant_cross_blocks;
			result.cross_block = std::max(result.cross_block, difference / (significant ? block.norm() : largest));
		}
	}
	return result;
}

inline std::ostream& operator<<(std::ostream& out, const CovarianceDifference& d)
{
	return out << "largest difference: diagonal entry " << 100 * d.diagonal_entry << " %, diagonal block " << 100 * d.diagonal_block
	           << " %, cross block " << 100 * d.cross_block << " % (" << d.significant_cross_blocks << " significant)";
}

/** Draws of a Monte Carlo: fewer in instrumented builds, which are there to find faults of memory. */
constexpr int monteCarloDraws(int draws)
{
#if defined(__SANITIZE_ADDRESS__)
	return draws / 20;
#else
	return draws;
#endif
}

/** Bar on a Monte Carlo comparison; instrumented builds draw a twentieth, whose sampling error is over four times as large. */
constexpr double monteCarloBar(double bar)
{
#if defined(__SANITIZE_ADDRESS__)
	return 3 * bar;
#else
	return bar;
#endif
}
}  // namespace viwo::test
