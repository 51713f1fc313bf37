#include <viwo/core/So3.h>

#include <Eigen/Cholesky>
#include <vector>

#include "BundleAdjustment.h"
#include "Linearisation.h"

namespace viwo::sfm
{
namespace
{
/** Information about the poses, the points eliminated. The point's fourth direction, along X itself, is none: it is filled by X X^T. */
Eigen::MatrixXd reducedInformation(const Scene& scene)
{
	const auto n = static_cast<Eigen::Index>(6 * scene.T_r_ck.size());
	Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
	for (const ScenePoint& point : scene.points)
	{
		if (!point.X) continue;
		Eigen::Matrix4d H_point = *point.X * point.X->transpose();
		Eigen::MatrixXd W = Eigen::MatrixXd::Zero(n, 4);
		for (const Observation& o : point.track.observations)
		{
			const Linearised L = linearise(*point.X, scene.T_r_ck[static_cast<size_t>(o.frame)].value(), o.bearing);
			const Eigen::Index at = Eigen::Index{6} * o.frame;
			H.block<6, 6>(at, at) += L.camera.transpose() * L.camera;
			W.middleRows<6>(at) += L.camera.transpose() * L.point;
			H_point += L.point.transpose() * L.point;
		}
		H -= W * H_point.ldlt().solve(W.transpose());
	}
	return H;
}

/** Change of [position of cb in ca's axes, right perturbation of R_ca_cb] with the poses of a and b. */
Eigen::MatrixXd intervalJacobian(const Scene& scene)
{
	const auto frames = static_cast<Eigen::Index>(scene.T_r_ck.size());
	Eigen::MatrixXd J = Eigen::MatrixXd::Zero(6 * (frames - 1), 6 * frames);
	for (Eigen::Index k = 0; k + 1 < frames; ++k)
	{
		const Pose3& a = scene.T_r_ck[static_cast<size_t>(k)].value();
		const Pose3& b = scene.T_r_ck[static_cast<size_t>(k + 1)].value();
		const Eigen::Matrix3d R_a_r = a.R.conjugate().toRotationMatrix();
		J.block<3, 3>(6 * k, 6 * k) = -R_a_r;
		J.block<3, 3>(6 * k, 6 * k + 3) = so3::skew(R_a_r * (b.p - a.p));
		J.block<3, 3>(6 * k, 6 * k + 6) = R_a_r;
		J.block<3, 3>(6 * k + 3, 6 * k + 3) = -(b.R.conjugate() * a.R).toRotationMatrix();
		J.block<3, 3>(6 * k + 3, 6 * k + 9) = Eigen::Matrix3d::Identity();
	}
	return J;
}
}  // namespace

Eigen::MatrixXd intervalCovariance(const Scene& scene, double sigma_rad)
{
	Eigen::MatrixXd H = reducedInformation(scene) / (sigma_rad * sigma_rad);
	// The gauge, held where adjust() holds it: the reference's pose and the scale frame's distance. A stiff prior on gauge directions
	// changes nothing else.
	const double stiff = H.diagonal().maxCoeff();
	const Eigen::Index r = Eigen::Index{6} * scene.reference, s = Eigen::Index{6} * scene.scale_frame;
	H.block<6, 6>(r, r) += stiff * Eigen::Matrix<double, 6, 6>::Identity();
	const Eigen::Vector3d u = scene.T_r_ck[static_cast<size_t>(scene.scale_frame)].value().p.normalized();
	H.block<3, 3>(s, s) += stiff * u * u.transpose();

	const Eigen::LDLT<Eigen::MatrixXd> factor(H);
	if (factor.info() != Eigen::Success || !factor.isPositive() || factor.rcond() < 1e-15) return {};
	const Eigen::MatrixXd J = intervalJacobian(scene);
	return J * factor.solve(J.transpose());
}
}  // namespace viwo::sfm
