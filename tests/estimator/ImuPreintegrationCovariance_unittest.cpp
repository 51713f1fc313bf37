// Propagated covariance against a Monte Carlo that perturbs the stream of samples: each raw sample once, whichever intervals and steps use
// it.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "CovarianceComparison.h"
#include "ImuMotion.h"
#include "ImuPreintegration.h"
#include "StateOrder.h"

using namespace viwo;
using namespace viwo::test;

namespace
{
constexpr int64_t kPeriod_ns = 5000000;
constexpr double kPeriod_s = 5e-3;

/** The trapezoid written out, apart from the class under test: fast, and of the same order. */
ImuDelta integrated(const std::vector<int64_t>& t_ns, const std::vector<Eigen::Vector3d>& acc, const std::vector<Eigen::Vector3d>& gyro)
{
	ImuDelta x;
	for (size_t i = 1; i < t_ns.size(); ++i)
	{
		const double h = secondsBetween(t_ns[i - 1], t_ns[i]);
		const Eigen::Vector3d half = 0.25 * h * (gyro[i - 1] + gyro[i]);
		// Half a step's rotation: the first terms of sin and cos, whose error at 200 Hz is below 1e-12.
		const double s = half.squaredNorm();
		const Eigen::Vector3d xyz = 0.5 * (1 - s / 24) * half;
		const Eigen::Quaterniond half_R(1 - s / 8 + s * s / 384, xyz.x(), xyz.y(), xyz.z());
		const Eigen::Quaterniond R_mid = x.gamma * half_R;
		const Eigen::Vector3d a = R_mid * (0.5 * (acc[i - 1] + acc[i]));
		x.alpha += x.beta * h + 0.5 * h * h * a;
		x.beta += h * a;
		x.gamma = R_mid * half_R;
	}
	x.gamma.normalize();
	return x;
}

class SampleStream
{
   public:
	SampleStream(const ImuNoise& noise, int64_t t_begin_ns, int64_t t_end_ns) : noise_(noise), t_begin_ns_(t_begin_ns), t_end_ns_(t_end_ns)
	{
		const ImuMotion motion;
		const int64_t first = t_begin_ns / kPeriod_ns, last = (t_end_ns + kPeriod_ns - 1) / kPeriod_ns;
		for (int64_t i = first; i <= last; ++i) raw_.push_back(motion.sample(i * kPeriod_ns));
		for (const ImuSample& s : raw_) buffer_.add(s);
		const std::vector<ImuSample> span = buffer_.span(t_begin_ns, t_end_ns, 1).value();
		for (const ImuSample& s : span) span_t_ns_.push_back(s.t_ns);
		truth_ = cut();
	}

	ImuPreintegration preintegration() const { return preintegrated(buffer_, t_begin_ns_, t_end_ns_, noise_); }

	/** Error of one draw, true minus integrated, in StateOrder. The true bias at the interval's start is that of the integration: zero. */
	Eigen::Matrix<double, 15, 1> draw(UnitErrors& errors)
	{
		const double sqrt_rate = 1 / std::sqrt(kPeriod_s);
		// The bias is a Brownian path that is zero at the start; a sample before the start sits on the path's other arm.
		Eigen::Vector3d b_a = Eigen::Vector3d::Zero(), b_g = Eigen::Vector3d::Zero();
		const auto walk = [&](double dt_s)
		{
			const double s = std::sqrt(dt_s);
			b_a += noise_.acc_walk_m_s3_sqrtHz * s * errors.vector3();
			b_g += noise_.gyro_walk_rad_s2_sqrtHz * s * errors.vector3();
		};
		const size_t n = raw_.size();
		noise_acc_.resize(n);
		noise_gyro_.resize(n);
		for (size_t i = 0; i < n; ++i)
		{
			const int64_t previous_ns = i <= 1 ? t_begin_ns_ : raw_[i - 1].t_ns;
			if (i == 1) b_a = b_g = Eigen::Vector3d::Zero();
			if (i + 1 == n) break;
			walk(std::abs(secondsBetween(previous_ns, raw_[i].t_ns)));
			noise_acc_[i] = b_a + noise_.acc_noise_m_s2_sqrtHz * sqrt_rate * errors.vector3();
			noise_gyro_[i] = b_g + noise_.gyro_noise_rad_s_sqrtHz * sqrt_rate * errors.vector3();
		}
		walk(secondsBetween(raw_[n - 2].t_ns, t_end_ns_));
		Eigen::Matrix<double, 15, 1> error;
		error.segment<3>(StateOrder::b_a) = b_a;
		error.segment<3>(StateOrder::b_g) = b_g;
		walk(secondsBetween(t_end_ns_, raw_[n - 1].t_ns));
		noise_acc_[n - 1] = b_a + noise_.acc_noise_m_s2_sqrtHz * sqrt_rate * errors.vector3();
		noise_gyro_[n - 1] = b_g + noise_.gyro_noise_rad_s_sqrtHz * sqrt_rate * errors.vector3();
		error.head<9>() = difference(truth_, cut());
		return error;
	}

   private:
	/** Integral of the raw samples plus their present noise, ends interpolated. */
	ImuDelta cut()
	{
		noise_acc_.resize(raw_.size(), Eigen::Vector3d::Zero());
		noise_gyro_.resize(raw_.size(), Eigen::Vector3d::Zero());
		const size_t n = raw_.size();
		acc_.resize(n);
		gyro_.resize(n);
		for (size_t i = 0; i < n; ++i)
		{
			acc_[i] = raw_[i].acc_m_s2 + noise_acc_[i];
			gyro_[i] = raw_[i].gyro_rad_s + noise_gyro_[i];
		}
		const double u = secondsBetween(raw_[0].t_ns, t_begin_ns_) / kPeriod_s, w = secondsBetween(raw_[n - 2].t_ns, t_end_ns_) / kPeriod_s;
		acc_[0] += u * (acc_[1] - acc_[0]);
		gyro_[0] += u * (gyro_[1] - gyro_[0]);
		acc_[n - 1] = acc_[n - 2] + w * (acc_[n - 1] - acc_[n - 2]);
		gyro_[n - 1] = gyro_[n - 2] + w * (gyro_[n - 1] - gyro_[n - 2]);
		return integrated(span_t_ns_, acc_, gyro_);
	}

	ImuNoise noise_;
	int64_t t_begin_ns_, t_end_ns_;
	std::vector<ImuSample> raw_;
	ImuBuffer buffer_;
	std::vector<int64_t> span_t_ns_;
	ImuDelta truth_;
	std::vector<Eigen::Vector3d> noise_acc_, noise_gyro_, acc_, gyro_;
};

/** Every diagonal entry, diagonal block and cross block of the 15x15. */
CovarianceDifference differenceToMonteCarlo(const ImuNoise& noise, int64_t t_begin_ns, int64_t t_end_ns, int draws)
{
	SampleStream stream(noise, t_begin_ns, t_end_ns);
	const ImuPreintegration p = stream.preintegration();
	UnitErrors errors(11);
	SampleCovariance<15> drawn;
	for (int i = 0; i < monteCarloDraws(draws); ++i) drawn.add(stream.draw(errors));
	const CovarianceDifference d = compareCovariances<15>(p.covariance(), drawn.value());
	std::cout << "[measured] " << p.dt_s() << " s, " << p.samples().size() << " samples, " << monteCarloDraws(draws) << " draws: " << d
	          << "\n";
	return d;
}

/** White and walking noise large enough that every bias block correlates with motion visibly. */
ImuNoise livelyNoise()
{
	ImuNoise noise;
	noise.acc_noise_m_s2_sqrtHz = 0.02;
	noise.gyro_noise_rad_s_sqrtHz = 0.01;
	noise.acc_walk_m_s3_sqrtHz = 0.3;
	noise.gyro_walk_rad_s2_sqrtHz = 0.2;
	return noise;
}
constexpr double kBar = 0.05;
}  // namespace

TEST(ImuPreintegrationCovariance, DefaultNoiseOverATenthOfASecond)
{
	EXPECT_LT(differenceToMonteCarlo({}, 0, 100000000, 150000).worst(), monteCarloBar(kBar));
}

TEST(ImuPreintegrationCovariance, DefaultNoiseInterpolatedEnds)
{
	EXPECT_LT(differenceToMonteCarlo({}, 2345678, 102345678, 150000).worst(), monteCarloBar(kBar));
	EXPECT_LT(differenceToMonteCarlo({}, 3900000, 101100000, 150000).worst(), monteCarloBar(kBar));
}

TEST(ImuPreintegrationCovariance, DefaultNoiseOverHalfASecond)
{
	EXPECT_LT(differenceToMonteCarlo({}, 1234567, 501234567, 100000).worst(), monteCarloBar(kBar));
}

TEST(ImuPreintegrationCovariance, LargeWalkCrossBlocks)
{
	const CovarianceDifference tenth = differenceToMonteCarlo(livelyNoise(), 2345678, 102345678, 150000);
	EXPECT_LT(tenth.worst(), monteCarloBar(kBar));
	EXPECT_GE(tenth.significant_cross_blocks, 4);
	const CovarianceDifference half = differenceToMonteCarlo(livelyNoise(), 1234567, 501234567, 100000);
	EXPECT_LT(half.worst(), monteCarloBar(kBar));
	EXPECT_GE(half.significant_cross_blocks, 6);
}
