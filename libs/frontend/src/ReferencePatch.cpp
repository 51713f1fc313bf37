#include "ReferencePatch.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace viwo
{
namespace
{
constexpr int kIterations = 20;
constexpr float kConverged_px = 0.03f;
constexpr float kLeastContrast = 1;     // grey levels rms: below, noise would be aligned
constexpr float kConditioning = 1e-3f;  // determinant over squared trace of the translation's Hessian: below, the patch is an edge
constexpr float kLargestStep = 3;       // change of area in one step

/** Bilinear; x and y in [0, size - 2). */
float interpolate(const cv::Mat& grey, float x, float y)
{
	const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
	const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
	const uint8_t* upper = grey.ptr<uint8_t>(y0) + x0;
	const uint8_t* lower = grey.ptr<uint8_t>(y0 + 1) + x0;
	const float a = static_cast<float>(upper[0]) + fx * static_cast<float>(upper[1] - upper[0]);
	const float b = static_cast<float>(lower[0]) + fx * static_cast<float>(lower[1] - lower[0]);
	return a + fy * (b - a);
}
}  // namespace

std::optional<ReferencePatch> ReferencePatch::at(const cv::Mat& grey, const cv::Point2f& centre_px, int side_px)
{
	ReferencePatch patch;
	patch.side_px_ = side_px;
	const Eigen::Vector2f centre(centre_px.x, centre_px.y);
	if (!patch.sample(grey, {centre, Eigen::Matrix2f::Identity()}, patch.values_)) return std::nullopt;
	if (!patch.setGradients(grey, centre)) return std::nullopt;
	return patch;
}

bool ReferencePatch::sample(const cv::Mat& grey, const Warp& warp, Eigen::VectorXf& values) const
{
	const int half_px = side_px_ / 2;
	const auto half = static_cast<float>(half_px);
	const float right = static_cast<float>(grey.cols - 2), bottom = static_cast<float>(grey.rows - 2);
	const auto inside = [&](float x, float y)
	{
		const Eigen::Vector2f p = warp.position_px + warp.A * Eigen::Vector2f(x, y);
		return p.x() >= 0 && p.y() >= 0 && p.x() < right && p.y() < bottom;
	};
	// A parallelogram lies inside of the image when its corners do.
	if (!inside(-half, -half) || !inside(half, -half) || !inside(-half, half) || !inside(half, half)) return false;

	values.resize(Eigen::Index{side_px_} * side_px_);
	Eigen::Index i = 0;
	for (int row = 0; row < side_px_; ++row)
	{
		const Eigen::Vector2f start = warp.position_px + warp.A * Eigen::Vector2f(-half, static_cast<float>(row) - half);
		for (int column = 0; column < side_px_; ++column)
		{
			const Eigen::Vector2f p = start + static_cast<float>(column) * warp.A.col(0);
			values(i++) = interpolate(grey, p.x(), p.y());
		}
	}
	values.array() -= values.mean();
	const float norm = values.norm();
	if (norm < kLeastContrast * static_cast<float>(side_px_)) return false;
	values /= norm;
	return true;
}

bool ReferencePatch::setGradients(const cv::Mat& grey, const Eigen::Vector2f& centre_px)
{
	Eigen::VectorXf left, right, up, down;
	const auto shifted = [&](float dx, float dy, Eigen::VectorXf& values) {
		return sample(grey, {centre_px + Eigen::Vector2f(dx, dy), Eigen::Matrix2f::Identity()}, values);
	};
	if (!shifted(-1, 0, left) || !shifted(1, 0, right) || !shifted(0, -1, up) || !shifted(0, 1, down)) return false;

	steepest_.resize(values_.size(), 6);
	steepest_.col(0) = (right - left) / 2;
	steepest_.col(1) = (down - up) / 2;
	const int half_px = side_px_ / 2;
	for (Eigen::Index i = 0; i < values_.size(); ++i)
	{
		const Eigen::Index column = i % side_px_ - half_px, row = i / side_px_ - half_px;
		const auto x = static_cast<float>(column), y = static_cast<float>(row);
		steepest_.row(i).segment<2>(2) = x * steepest_.row(i).head<2>();
		steepest_.row(i).segment<2>(4) = y * steepest_.row(i).head<2>();
	}
	const Eigen::Matrix<float, 6, 6> hessian = steepest_.transpose() * steepest_;
	const Eigen::Matrix2f shift = hessian.topLeftCorner<2, 2>();
	if (shift.determinant() < kConditioning * shift.trace() * shift.trace()) return false;
	const Eigen::LDLT<Eigen::Matrix<float, 6, 6>> factors(hessian);
	if (factors.info() != Eigen::Success || !factors.isPositive()) return false;
	covariance_ = factors.solve(Eigen::Matrix<float, 6, 6>::Identity());
	return covariance_.allFinite();
}

std::optional<float> ReferencePatch::improve(const Eigen::VectorXf& seen, Warp& warp) const
{
	const Eigen::Matrix<float, 6, 1> step = covariance_ * (steepest_.transpose() * (seen - values_));
	Eigen::Matrix2f D = Eigen::Matrix2f::Identity();
	D.col(0) += step.segment<2>(2);
	D.col(1) += step.segment<2>(4);
	if (!(D.determinant() > 1 / kLargestStep && D.determinant() < kLargestStep)) return std::nullopt;
	warp.A = warp.A * D.inverse();
	const Eigen::Vector2f shift_px = warp.A * step.head<2>();
	warp.position_px -= shift_px;
	return shift_px.norm();
}

std::optional<cv::Point2f> ReferencePatch::find(const cv::Mat& grey, const cv::Point2f& near_px, const TrackerOptions& options)
{
	Warp warp{{near_px.x, near_px.y}, A_};
	Eigen::VectorXf seen;
	std::optional<float> shift_px;
	for (int i = 0; i < kIterations && !(shift_px && *shift_px < kConverged_px); ++i)
	{
		if (!sample(grey, warp, seen)) return std::nullopt;
		shift_px = improve(seen, warp);
		if (!shift_px) return std::nullopt;
	}
	const cv::Point2f found(warp.position_px.x(), warp.position_px.y());
	const bool converged = *shift_px < kConverged_px && cv::norm(found - near_px) < options.reference_shift_px;
	if (!converged || seen.dot(values_) < static_cast<float>(options.reference_correlation)) return std::nullopt;
	A_ = warp.A;
	return found;
}
}  // namespace viwo
