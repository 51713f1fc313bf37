#include "ScaleAlignment.h"

#include <viwo/core/So3.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <cmath>

#include "ScaleAlignmentRows.h"

namespace viwo
{
namespace
{
constexpr int kRounds = 5;
constexpr double kMaxCondition = 1e8;
constexpr double kGravityTolerance = 0.2;  // of |g|: accelerations of a start included

using Index = Eigen::Index;

struct Solution
{
	Eigen::VectorXd x;
	Eigen::MatrixXd covariance;
	double condition = 0;
	double chi2_per_dof = 0;
};

/** Least squares by singular values, columns brought to unit norm first. */
Solution leastSquares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b)
{
	const Eigen::VectorXd norms = A.colwise().norm().cwiseMax(1e-300);
	const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A * norms.cwiseInverse().asDiagonal(), Eigen::ComputeThinU | Eigen::ComputeThinV);
	const Eigen::VectorXd sigma = svd.singularValues();
	Solution solution;
	solution.condition = sigma[0] / std::max(sigma[sigma.size() - 1], 1e-300);
	if (solution.condition > kMaxCondition) return solution;
	const Eigen::MatrixXd V = norms.cwiseInverse().asDiagonal() * svd.matrixV() * sigma.cwiseInverse().asDiagonal();
	solution.x = V * (svd.matrixU().transpose() * b);
	solution.covariance = V * V.transpose();
	solution.chi2_per_dof = (b - A * solution.x).squaredNorm() / static_cast<double>(std::max<Index>(1, A.rows() - A.cols()));
	return solution;
}

Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& up)
{
	const Eigen::Vector3d aside = std::abs(up.x()) < 0.8 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
	Eigen::Matrix<double, 3, 2> basis;
	basis.col(0) = up.cross(aside).normalized();
	basis.col(1) = up.cross(basis.col(0));
	return basis;
}

/** Unweighted, with all of gravity unknown: VINS-Mono's start. */
Eigen::Vector3d freeGravity(const ScaleAlignmentRows& rows)
{
	Eigen::MatrixXd A;
	Eigen::VectorXd b;
	rows.system(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), A, b);
	const Solution solution = leastSquares(A, b);
	return solution.x.size() == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(solution.x.tail<3>());
}

Eigen::Vector3d startingGravity(const ScaleAlignmentRows& rows, const Calibration& calibration, bool has_wheels, double g,
                                const InitializerOptions& options)
{
	if (!has_wheels)
	{
		const Eigen::Vector3d free = freeGravity(rows);
		if (std::abs(free.norm() - g) < kGravityTolerance * g) return free;
	}
	if (has_wheels && options.gravity_start == GravityStart::vehicle_up)
	{
		const Eigen::Vector3d up_C = calibration.T_OC.R.conjugate() * Eigen::Vector3d::UnitZ();
		return up_C * g;
	}
	return rows.meanSpecificForce_c0();
}

/** Everything that the rounds of alignScale() improve. */
struct Iterate
{
	Eigen::Vector3d g_c0;
	std::vector<Pose3> T_c0_ck;
	Eigen::VectorXd vision_correction;  //!< of the intervals, as SfmResult::interval_covariance orders them
	Solution solution;                  //!< empty before the first round
};

std::vector<Pose3> corrected(const std::vector<Pose3>& T_c0_ck, const Eigen::VectorXd& correction)
{
	std::vector<Pose3> result{T_c0_ck.front()};
	for (size_t k = 0; k + 1 < T_c0_ck.size(); ++k)
	{
		const Pose3 interval = T_c0_ck[k].inverse() * T_c0_ck[k + 1];
		const Eigen::Matrix<double, 6, 1> c = correction.segment<6>(6 * static_cast<Index>(k));
		result.push_back(result.back() * Pose3(interval.R * so3::expQuaternion(c.tail<3>()), interval.p + c.head<3>()));
	}
	return result;
}

/** One Gauss-Newton step of the Gauss-Helmert model; the very first is unweighted, because the noise depends on the scale. @return false
 * when it is singular. */
bool improve(const ScaleAlignmentRows& rows, const SfmResult& sfm, double g, Iterate& at)
{
	const Eigen::Matrix<double, 3, 2> basis = g * tangentBasis(at.g_c0.normalized());
	Eigen::MatrixXd A;
	Eigen::VectorXd b;
	rows.system(at.g_c0, basis, A, b);
	if (at.solution.x.size() == 0)
		at.solution = leastSquares(A, b);
	else
	{
		const Eigen::MatrixXd J = rows.visionJacobian(at.solution.x, at.g_c0);
		const Eigen::MatrixXd J_cov = J * sfm.interval_covariance;
		const Eigen::LLT<Eigen::MatrixXd> noise(J_cov * J.transpose() + rows.sensorCovariance());
		if (noise.info() != Eigen::Success) return false;
		b += J * at.vision_correction;
		at.solution = leastSquares(noise.matrixL().solve(A), noise.matrixL().solve(b));
		if (at.solution.x.size() > 0) at.vision_correction = J_cov.transpose() * noise.solve(b - A * at.solution.x);
	}
	if (at.solution.x.size() == 0) return false;
	at.g_c0 = (at.g_c0 + basis * at.solution.x.tail<2>()).normalized() * g;
	at.T_c0_ck = corrected(sfm.T_c0_ck, at.vision_correction);
	return true;
}

ScaleStatus judge(const ScaleResult& result, bool has_wheels, const InitializerOptions& options)
{
	const double max_sigma = has_wheels ? options.max_scale_sigma : options.max_scale_sigma_without_wheels;
	if (!(std::abs(result.scale_sigma) <= max_sigma)) return ScaleStatus::ill_conditioned;
	if (result.scale <= 0) return ScaleStatus::negative_scale;
	return result.chi2_per_dof <= options.max_chi2_per_dof ? ScaleStatus::ok : ScaleStatus::bad_residual;
}
}  // namespace

ScaleResult alignScale(const SfmResult& sfm, const std::vector<ImuPreintegration>& imu, const std::vector<WheelPreintegration>& wheels,
                       const Calibration& calibration, const Belief& belief, double gravity_m_s2, const InitializerOptions& options)
{
	Iterate at;
	at.T_c0_ck = sfm.T_c0_ck;
	at.vision_correction = Eigen::VectorXd::Zero(sfm.interval_covariance.rows());
	const ScaleAlignmentRows rows(at.T_c0_ck, imu, wheels, calibration, belief);
	ScaleResult result;
	at.g_c0 = startingGravity(rows, calibration, !wheels.empty(), gravity_m_s2, options);
	result.status = ScaleStatus::bad_gravity;
	if (std::abs(at.g_c0.norm() - gravity_m_s2) > kGravityTolerance * gravity_m_s2) return result;
	at.g_c0 = at.g_c0.normalized() * gravity_m_s2;

	for (int round = 0; round <= kRounds; ++round)
	{
		result.status = ScaleStatus::ill_conditioned;
		const bool regular = improve(rows, sfm, gravity_m_s2, at);
		result.condition = at.solution.condition;
		if (!regular) return result;
	}
	const Solution& solution = at.solution;
	const Index s = rows.scaleColumn();
	result.scale = solution.x[s];
	result.scale_sigma = std::sqrt(solution.covariance(s, s)) / std::abs(result.scale);
	result.up_c0 = at.g_c0.normalized();
	result.T_c0_ck = at.T_c0_ck;
	result.up_sigma_rad = std::sqrt(solution.covariance.diagonal().tail<2>().maxCoeff());
	result.covariance = solution.covariance;
	result.chi2_per_dof = solution.chi2_per_dof;
	for (Index k = 0; k <= rows.intervals(); ++k) result.v_B.emplace_back(solution.x.segment<3>(3 * k));
	result.status = judge(result, !wheels.empty(), options);
	return result;
}
}  // namespace viwo
