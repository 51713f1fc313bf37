// Propagated covariance against a Monte Carlo that perturbs the stream of samples: each wheel sample once, whichever intervals use its
// pieces.
#include <gtest/gtest.h>
#include <viwo/core/So3.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "CovarianceComparison.h"
#include "SampleBuffer.h"
#include "WheelPreintegration.h"

using namespace viwo;
using namespace viwo::test;

namespace
{
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
constexpr int64_t kMs = 1000000;
constexpr double kPeriod_s = 0.05;  // 20 Hz
constexpr int kDraws = 200000;
constexpr double kBar = 0.05;

/** The right wheel runs five times as fast as the left one, and so is its noise. */
const WheelIntrinsics kIntrinsics{1.01, 0.99, 0.23};
constexpr double kLeft_m_s = 0.05, kRight_m_s = 0.25;

WheelNoise wheelNoise()
{
	WheelNoise noise;
	noise.s0_m_s_sqrtHz = 5e-4;
	noise.k_sqrtHz = 0.02;
	return noise;
}

/** A twist of O with all six components, held over dt_s: fine midpoint steps, nothing shared with the class under test. */
Pose3 driven(const Pose3& start, const Eigen::Vector3d& v, const Eigen::Vector3d& w, double dt_s)
{
	constexpr int kSteps = 8;
	const double h = dt_s / kSteps;
	const double half = 0.5 * h * w.norm();
	const double sinc_half = half < 1e-8 ? 0.25 * h : std::sin(half / 2) / w.norm();
	const Eigen::Quaterniond half_step(std::cos(half / 2), sinc_half * w.x(), sinc_half * w.y(), sinc_half * w.z());
	Pose3 T = start;
	for (int i = 0; i < kSteps; ++i)
	{
		const Eigen::Quaterniond R_mid = T.R * half_step;
		T.p += R_mid * v * h;
		T.R = R_mid * half_step;
	}
	return T;
}

/** One piece of a sample between two image times, with the errors of that sample. */
struct Piece
{
	size_t sample;
	double dt_s;
};

class SampleStream
{
   public:
	/** Images cut the stream; @param count samples. */
	SampleStream(std::vector<int64_t> images_ns, int count)
	    : images_ns_(std::move(images_ns)), errors_(static_cast<size_t>(count), Vector6::Zero())
	{
		for (int i = 0; i <= count; ++i) buffer_.add({50 * i * kMs, kLeft_m_s, kRight_m_s});
		for (int i = 0; i < count; ++i)
		{
			const double from = std::max(50. * i, 1e-6 * static_cast<double>(images_ns_.front()));
			const double to = std::min(50. * (i + 1), 1e-6 * static_cast<double>(images_ns_.back()));
			if (to > from) pieces_.push_back({static_cast<size_t>(i), 1e-3 * (to - from)});
		}
		truth_ = drive();
	}

	/** The intervals between the images, appended. */
	WheelPreintegration preintegration() const
	{
		WheelPreintegration all(wheelNoise(), kIntrinsics);
		for (size_t i = 1; i < images_ns_.size(); ++i)
		{
			WheelPreintegration interval(wheelNoise(), kIntrinsics);
			const std::vector<WheelSegment> segments = buffer_.segments(images_ns_[i - 1], images_ns_[i], 0.2).value();
			for (const WheelSegment& segment : segments) interval.integrate(segment);
			all.append(interval);
		}
		return all;
	}

	/** O's motion as integrated from samples with freshly drawn errors. */
	Pose3 draw(UnitErrors& errors)
	{
		const WheelNoise noise = wheelNoise();
		const double rate = 1 / std::sqrt(kPeriod_s);
		const auto wheel = [&](double v)
		{ return std::sqrt(noise.s0_m_s_sqrtHz * noise.s0_m_s_sqrtHz + noise.k_sqrtHz * noise.k_sqrtHz * v * v) * rate * errors(); };
		for (Vector6& e : errors_)
		{
			const double left = wheel(kLeft_m_s), right = wheel(kRight_m_s);
			const double lateral = noise.lateral_m_s_sqrtHz * rate * errors(), vertical = noise.vertical_m_s_sqrtHz * rate * errors();
			const double roll = noise.tilt_rad_s_sqrtHz * rate * errors(), pitch = noise.tilt_rad_s_sqrtHz * rate * errors();
			const WheelTwist t = twistOf({0, left, right}, kIntrinsics);
			e << t.v_m_s, lateral, vertical, roll, pitch, t.w_rad_s;
		}
		return drive();
	}

	const Pose3& truth() const { return truth_; }

   private:
	Pose3 drive() const
	{
		const WheelTwist t = twistOf({0, kLeft_m_s, kRight_m_s}, kIntrinsics);
		Pose3 T;
		for (const Piece& piece : pieces_)
		{
			const Vector6& e = errors_[piece.sample];
			T = driven(T, Eigen::Vector3d(t.v_m_s, 0, 0) + e.head<3>(), Eigen::Vector3d(0, 0, t.w_rad_s) + e.tail<3>(), piece.dt_s);
		}
		T.R.normalize();
		return T;
	}

	std::vector<int64_t> images_ns_;
	std::vector<Vector6> errors_;
	WheelBuffer buffer_;
	std::vector<Piece> pieces_;
	Pose3 truth_;
};

Vector6 difference(const Pose3& to, const Pose3& from)
{
	Vector6 d;
	d << to.p - from.p, so3::log(Eigen::Quaterniond(from.R.conjugate() * to.R));
	return d;
}

Matrix6 drawnCovariance(SampleStream& stream)
{
	UnitErrors errors(5);
	SampleCovariance<6> drawn;
	for (int i = 0; i < monteCarloDraws(kDraws); ++i) drawn.add(difference(stream.draw(errors), stream.truth()));
	return drawn.value();
}

CovarianceDifference report(const char* what, const Matrix6& model, const Matrix6& drawn)
{
	const CovarianceDifference d = compareCovariances<6>(model, drawn);
	std::cout << "[measured] " << what << ", " << monteCarloDraws(kDraws) << " draws: " << d << "\n";
	return d;
}
}  // namespace

TEST(WheelPreintegrationCovariance, TwoSamplesAnInterval)
{
	SampleStream stream({0, 100 * kMs}, 2);
	ASSERT_EQ(stream.preintegration().segments().size(), 2u);
	const CovarianceDifference d = report("2 samples", stream.preintegration().covariance(), drawnCovariance(stream));
	EXPECT_LT(d.worst(), monteCarloBar(kBar));
	EXPECT_EQ(d.significant_cross_blocks, 1);
}

TEST(WheelPreintegrationCovariance, IntervalsJoinedAtImagesThatSplitSamples)
{
	for (const int64_t offset_ms : {15, 25, 40})
	{
		SampleStream stream({0, (50 + offset_ms) * kMs, 150 * kMs}, 3);
		ASSERT_EQ(stream.preintegration().segments().size(), 4u);
		EXPECT_LT(
		    report("3 samples, one split between two intervals", stream.preintegration().covariance(), drawnCovariance(stream)).worst(),
		    monteCarloBar(kBar));
	}
	SampleStream stream({0, 130 * kMs, 230 * kMs, 330 * kMs, 500 * kMs}, 10);
	EXPECT_LT(report("10 samples, three of them split", stream.preintegration().covariance(), drawnCovariance(stream)).worst(),
	          monteCarloBar(kBar));
}

// A single interval uses parts of its outer samples. Their noise, which the neighbouring interval shares, is counted there by its time and
// not by the square of its time: on the safe side alone, and right for the sum of intervals as they are joined above.
TEST(WheelPreintegrationCovariance, ASingleIntervalBetweenSamplesIsNotOverconfident)
{
	for (const int64_t offset_ms : {10, 25})
	{
		SampleStream stream({offset_ms * kMs, (100 + offset_ms) * kMs}, 3);
		const Matrix6 model = stream.preintegration().covariance(), drawn = drawnCovariance(stream);
		const Vector6 ratio = model.diagonal().cwiseQuotient(drawn.diagonal());
		std::cout << "[measured] image " << offset_ms << " ms after a sample: variance over drawn " << ratio.transpose() << "\n";
		EXPECT_GT(ratio.minCoeff(), 1 - monteCarloBar(kBar));
		EXPECT_LT(ratio.maxCoeff(), 1.5);
	}
}

// The wheel residual (Niu et al. Eq. 19) at the truth, through body poses with a lever arm: its covariance is the preintegration's own.
TEST(WheelPreintegrationCovariance, ResidualWithLeverArm)
{
	const Pose3 T_BO(so3::expQuaternion({0.3, -0.2, 1.1}), {0.5, -0.3, 0.2});
	const Pose3 T_WB_i(so3::expQuaternion({0.1, 0.2, -2}), {3, -4, 0.3});
	SampleStream stream({0, 100 * kMs}, 2);
	const Pose3 T_WB_j = T_WB_i * T_BO * stream.truth() * T_BO.inverse();
	const Pose3 T_WO_i = T_WB_i * T_BO, T_WO_j = T_WB_j * T_BO;

	UnitErrors errors(6);
	SampleCovariance<6> residuals, body_motions;
	for (int i = 0; i < monteCarloDraws(kDraws); ++i)
	{
		const Pose3 delta = stream.draw(errors);
		Vector6 r;
		r.head<3>() = T_WO_i.R.conjugate() * (T_WO_j.p - T_WO_i.p) - delta.p;
		r.tail<3>() = so3::log(Eigen::Quaterniond(delta.R.conjugate() * T_WO_i.R.conjugate() * T_WO_j.R));
		residuals.add(r);
		body_motions.add(difference(T_BO * delta * T_BO.inverse(), T_BO * stream.truth() * T_BO.inverse()));
	}
	const WheelPreintegration p = stream.preintegration();
	EXPECT_LT(report("residual", p.covariance(), residuals.value()).worst(), monteCarloBar(kBar));

	// The same motion as the body makes it: the arm turns yaw noise into translation.
	Matrix6 adjoint = Matrix6::Zero();
	const Eigen::Matrix3d R_BO = T_BO.R.toRotationMatrix();
	adjoint.block<3, 3>(0, 0) = R_BO;
	adjoint.block<3, 3>(0, 3) = -R_BO * p.dR().toRotationMatrix() * so3::skew(T_BO.inverse().p);
	adjoint.block<3, 3>(3, 3) = R_BO;
	const Matrix6 in_body = adjoint * p.covariance() * adjoint.transpose();
	EXPECT_LT(report("motion of the body on a lever arm", in_body, body_motions.value()).worst(), monteCarloBar(kBar));
}
