#include <viwo/core/CameraModel.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace viwo
{
namespace
{
using Distortion = CameraModel::Distortion;
using Coefficients = std::array<double, 5>;

constexpr double kRightAngle_rad = 1.5707963267948966;

/** Radius in the distorted normalised plane of a ray at undistorted radius r = tan(angle to the axis). */
double distortedRadius(Distortion distortion, const Coefficients& k, double r)
{
	if (distortion == Distortion::kannala_brandt)
	{
		const double a = std::atan(r), a2 = a * a;
		return a * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
	}
	const double r2 = r * r;
	return r * (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4])));
}

/** Has the sign of d(distorted radius)/dr at r = tan(angle_rad). */
double slopeSign(Distortion distortion, const Coefficients& k, double angle_rad)
{
	if (distortion == Distortion::kannala_brandt)
	{
		const double a2 = angle_rad * angle_rad;
		return 1 + a2 * (3 * k[0] + a2 * (5 * k[1] + a2 * (7 * k[2] + a2 * 9 * k[3])));
	}
	const double r = std::tan(angle_rad), r2 = r * r;
	return 1 + r2 * (3 * k[0] + r2 * (5 * k[1] + r2 * 7 * k[4]));
}

/** The r <= max_radius with distortedRadius(r) = target; max_radius where the lens does not reach the target. */
double undistortedRadius(Distortion distortion, const Coefficients& k, double target, double max_radius)
{
	if (distortion == Distortion::none || target == 0) return target;
	double low = 0, high = std::min(max_radius, std::max(1.0, 2 * target));
	while (high < max_radius && high < 1e9 && distortedRadius(distortion, k, high) < target) high = std::min(2 * high, max_radius);
	if (distortedRadius(distortion, k, high) <= target) return high;
	// Secant steps kept inside of a bracket that bisection shrinks: converges from any start, also beside the turning point.
	double r = std::min(target, 0.5 * high);
	for (int i = 0; i < 100 && high - low > 1e-15 * high; i++)
	{
		const double error = distortedRadius(distortion, k, r) - target;
		(error > 0 ? high : low) = r;
		const double h = 1e-6 * (1 + r);
		const double slope = (distortedRadius(distortion, k, r + h) - distortedRadius(distortion, k, r - h)) / (2 * h);
		const double newton = r - error / slope;
		const bool inside = newton > low && newton < high;
		if (inside && std::abs(newton - r) < 1e-14 * (1 + r)) return newton;
		r = inside ? newton : 0.5 * (low + high);
	}
	return r;
}
}  // namespace

CameraModel::CameraModel(int width_px, int height_px, double fx_px, double fy_px, double cx_px, double cy_px, Distortion distortion,
                         const std::array<double, 5>& coefficients)
    : width_px_(width_px),
      height_px_(height_px),
      fx_px_(fx_px),
      fy_px_(fy_px),
      cx_px_(cx_px),
      cy_px_(cy_px),
      distortion_(distortion),
      coefficients_(coefficients)
{
	findTurningPoint();
}

void CameraModel::findTurningPoint()
{
	max_radius_ = std::numeric_limits<double>::infinity();
	if (distortion_ == Distortion::none) return;
	constexpr int kSteps = 1024;
	const double step_rad = kRightAngle_rad / kSteps;
	int i = 1;
	while (i < kSteps && slopeSign(distortion_, coefficients_, i * step_rad) > 0) i++;
	if (i == kSteps) return;
	double low = (i - 1) * step_rad, high = i * step_rad;
	for (int bisection = 0; bisection < 50; bisection++)
	{
		const double middle = 0.5 * (low + high);
		(slopeSign(distortion_, coefficients_, middle) > 0 ? low : high) = middle;
	}
	max_radius_ = std::tan(low);
}

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& normalised) const
{
	const double r = normalised.norm();
	if (distortion_ == Distortion::none || r == 0) return normalised;
	const Eigen::Vector2d radial = normalised * (distortedRadius(distortion_, coefficients_, r) / r);
	if (distortion_ == Distortion::kannala_brandt) return radial;
	const double x = normalised.x(), y = normalised.y(), r2 = r * r;
	const double p1 = coefficients_[2], p2 = coefficients_[3];
	return radial + Eigen::Vector2d(2 * p1 * x * y + p2 * (r2 + 2 * x * x), p1 * (r2 + 2 * y * y) + 2 * p2 * x * y);
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& P_C) const
{
	if (!(P_C.z() > 0)) return std::nullopt;
	const Eigen::Vector2d normalised = P_C.head<2>() / P_C.z();
	if (!(normalised.norm() <= max_radius_)) return std::nullopt;
	const Eigen::Vector2d d = distort(normalised);
	return Eigen::Vector2d(fx_px_ * d.x() + cx_px_, fy_px_ * d.y() + cy_px_);
}

Eigen::Vector3d CameraModel::unproject(const Eigen::Vector2d& pixel) const
{
	const Eigen::Vector2d target((pixel.x() - cx_px_) / fx_px_, (pixel.y() - cy_px_) / fy_px_);
	const double target_radius = target.norm();
	Eigen::Vector2d x = target;
	if (target_radius > 0) x *= undistortedRadius(distortion_, coefficients_, target_radius, max_radius_) / target_radius;
	if (distortion_ == Distortion::plumb_bob && (coefficients_[2] != 0 || coefficients_[3] != 0))
	{
		// The radial solution is the start; what remains is the small tangential part.
		for (int i = 0; i < 20; i++)
		{
			constexpr double h = 1e-6;
			Eigen::Matrix2d J;
			J.col(0) = (distort(x + Eigen::Vector2d(h, 0)) - distort(x - Eigen::Vector2d(h, 0))) / (2 * h);
			J.col(1) = (distort(x + Eigen::Vector2d(0, h)) - distort(x - Eigen::Vector2d(0, h))) / (2 * h);
			const Eigen::Vector2d step = J.inverse() * (distort(x) - target);
			if (!step.allFinite() || step.norm() > 1) break;
			x -= step;
			if (step.norm() < 1e-12) break;
		}
	}
	return Eigen::Vector3d(x.x(), x.y(), 1).normalized();
}

bool CameraModel::contains(const Eigen::Vector2d& pixel, double border_px) const
{
	return pixel.x() >= border_px && pixel.y() >= border_px && pixel.x() <= width_px_ - 1 - border_px &&
	       pixel.y() <= height_px_ - 1 - border_px;
}
}  // namespace viwo
