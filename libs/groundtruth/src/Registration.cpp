#include "Registration.h"

#include <viwo/core/Scalars.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>

namespace viwo::gt
{
namespace
{
struct NormalEquations
{
	Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  //!< weighted
	Eigen::Vector3d b = Eigen::Vector3d::Zero();
	Eigen::Matrix2d facing = Eigen::Matrix2d::Zero();  //!< sum of n n^T over the inliers
	int points = 0, inliers = 0;
	double squares = 0;
};

/** Scan points to lines: r = n . (T x - q), J = [n^T, n . (R x)^perp]. */
NormalEquations linearise(const Cloud& scan, const PointIndex& map, const Pose2& T, double radius_m, const RegistrationOptions& options)
{
	NormalEquations e;
	const Eigen::Matrix2d R = T.R();
	const double kernel2 = options.kernel_m * options.kernel_m, weight0 = 1 / (options.sigma_m * options.sigma_m);
	for (const OrientedPoint& point : scan)
	{
		if (!point.hasNormal()) continue;
		++e.points;
		const Eigen::Vector2d arm = R * point.p;
		const OrientedPoint* q = map.nearest(arm + T.p, R * point.n, radius_m);
		if (!q) continue;
		const double r = q->n.dot(arm + T.p - q->p);
		const double scale = kernel2 / (kernel2 + r * r);
		const double w = weight0 * scale * scale;
		const Eigen::Vector3d J(q->n.x(), q->n.y(), q->n.y() * arm.x() - q->n.x() * arm.y());
		e.H.noalias() += w * J * J.transpose();
		e.b.noalias() += w * r * J;
		if (r * r > kernel2) continue;
		++e.inliers;
		e.squares += r * r;
		e.facing.noalias() += q->n * q->n.transpose();
	}
	return e;
}

void describe(const NormalEquations& e, Registration& result)
{
	result.information = e.H;
	result.points = e.points;
	result.inliers = e.inliers;
	result.rms_m = e.inliers > 0 ? std::sqrt(e.squares / e.inliers) : 0;
	if (e.inliers == 0) return;
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
	solver.computeDirect(e.facing / e.inliers);
	result.weakest = solver.eigenvalues()[0];
	result.weakest_direction = solver.eigenvectors().col(0);
}
}  // namespace

double Registration::trust(double min_weakest) const
{
	return square(std::clamp(weakest / min_weakest - 1, 0.0, 1.0));
}

Eigen::Matrix3d Registration::trustedInformation(double share) const
{
	Eigen::Matrix3d P = Eigen::Matrix3d::Identity();
	P.topLeftCorner<2, 2>() -= (1 - std::sqrt(share)) * weakest_direction * weakest_direction.transpose();
	return P * information * P;
}

Registration registerCloud(const Cloud& scan, const PointIndex& map, const Pose2& T_guess, const PosePrior* prior,
                           const RegistrationOptions& options)
{
	Registration result;
	result.T = T_guess;
	double radius_m = options.first_radius_m;
	for (int i = 0; i < options.iterations; ++i)
	{
		const NormalEquations e = linearise(scan, map, result.T, radius_m, options);
		Eigen::Matrix3d H = e.H;
		Eigen::Vector3d b = e.b;
		if (prior)
		{
			const Eigen::Vector2d dp = result.T.p - prior->T.p;
			H += prior->information;
			b += prior->information * Eigen::Vector3d(dp.x(), dp.y(), wrapped(result.T.yaw - prior->T.yaw));
		}
		H.diagonal().array() += 1e-3;
		const Eigen::Vector3d step = -H.ldlt().solve(b);
		result.T.p += step.head<2>();
		result.T.yaw = wrapped(result.T.yaw + step.z());
		const bool last_radius = radius_m <= options.last_radius_m;
		if (last_radius && step.head<2>().norm() < 2e-4 && std::abs(step.z()) < 5e-5) break;
		radius_m = std::max(options.last_radius_m, 0.6 * radius_m);
	}
	describe(linearise(scan, map, result.T, options.last_radius_m, options), result);
	return result;
}
}  // namespace viwo::gt
