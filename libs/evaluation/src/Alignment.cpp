#include <viwo/core/Error.h>
#include <viwo/evaluation/Alignment.h>

#include <Eigen/SVD>

#include <cmath>

namespace viwo
{
namespace
{
/** Length of the lever by which orientations take part, relative to the radius of the trajectory. */
constexpr double kOrientationLever = 1e-3;
/** Below this radius (m) the orientations decide alone. */
constexpr double kSmallestLever_m = 1e-9;

struct Moments
{
	Eigen::Vector3d mean_ref = Eigen::Vector3d::Zero();
	Eigen::Vector3d mean_est = Eigen::Vector3d::Zero();
	Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();      //!< mean of (ref - mean)(est - mean)^T, without orientations
	Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();  //!< mean of R_ref R_est^T
	double variance_ref = 0, variance_est = 0;            //!< mean squared distance from the mean

	Eigen::Matrix3d crossWithOrientations() const
	{
		const double lever = kOrientationLever * std::sqrt(std::sqrt(variance_ref * variance_est)) + kSmallestLever_m;
		return cross + lever * lever * rotations;
	}
};

Moments momentsOf(const std::vector<Pose3>& reference, const std::vector<Pose3>& estimate)
{
	Moments m;
	const double n = static_cast<double>(reference.size());
	for (size_t i = 0; i < reference.size(); ++i)
	{
		m.mean_ref += reference[i].p / n;
		m.mean_est += estimate[i].p / n;
	}
	for (size_t i = 0; i < reference.size(); ++i)
	{
		const Eigen::Vector3d ref = reference[i].p - m.mean_ref;
		const Eigen::Vector3d est = estimate[i].p - m.mean_est;
		m.cross += ref * est.transpose() / n;
		m.variance_ref += ref.squaredNorm() / n;
		m.variance_est += est.squaredNorm() / n;
		m.rotations += (reference[i].R * estimate[i].R.conjugate()).toRotationMatrix() / n;
	}
	return m;
}

/** The rotation R that maximises trace(R^T M) (Umeyama's Eqs. 39-43). */
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& M)
{
	const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
	Eigen::Vector3d signs = Eigen::Vector3d::Ones();
	if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
	return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Eigen::Matrix3d nearestYaw(const Eigen::Matrix3d& M)
{
	const double yaw = std::atan2(M(1, 0) - M(0, 1), M(0, 0) + M(1, 1));
	return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}
}  // namespace

const char* toString(AlignmentKind kind)
{
	switch (kind)
	{
		case AlignmentKind::se3:
			return "se3";
		case AlignmentKind::yaw:
			return "yaw";
		case AlignmentKind::none:
			return "none";
		case AlignmentKind::sim3:
			return "sim3";
	}
	return "?";
}

AlignmentKind alignmentFromString(const std::string& word)
{
	for (const AlignmentKind kind : {AlignmentKind::se3, AlignmentKind::yaw, AlignmentKind::none, AlignmentKind::sim3})
		if (word == toString(kind)) return kind;
	throw Error("alignment '" + word + "' is not known: use se3, yaw, none or sim3");
}

Pose3 Similarity::operator*(const Pose3& T_est) const
{
	return {(T_ref_est.R * T_est.R).normalized(), scale * (T_ref_est.R * T_est.p) + T_ref_est.p};
}

Similarity align(AlignmentKind kind, const std::vector<Pose3>& reference, const std::vector<Pose3>& estimate)
{
	Similarity s;
	if (kind == AlignmentKind::none) return s;
	const Moments m = momentsOf(reference, estimate);
	const Eigen::Matrix3d M = m.crossWithOrientations();
	const Eigen::Matrix3d R = kind == AlignmentKind::yaw ? nearestYaw(M) : nearestRotation(M);
	// Umeyama's Eq. 42; a point has no scale.
	if (kind == AlignmentKind::sim3 && m.variance_est > 0) s.scale = (R.transpose() * m.cross).trace() / m.variance_est;
	s.T_ref_est = Pose3(R, m.mean_ref - s.scale * R * m.mean_est);
	return s;
}
}  // namespace viwo
