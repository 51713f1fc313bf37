#include "GyroBiasAlignment.h"

#include <viwo/core/So3.h>

#include <Eigen/Cholesky>

#include "StateOrder.h"

namespace viwo
{
namespace
{
constexpr int kRounds = 3;
constexpr int kGyroColumn = 3;  // of ImuPreintegration::BiasJacobian

using Index = Eigen::Index;

/** Rows of Eq. 9 (three an interval) and, behind them, of Eq. 10: r = r_now - J d. */
struct Rows
{
	Eigen::VectorXd r;
	Eigen::MatrixXd J;
	Eigen::MatrixXd covariance;
};

struct Inputs
{
	const SfmResult& sfm;
	const std::vector<ImuPreintegration>& imu;
	const std::vector<WheelPreintegration>& wheels;
	const Calibration& calibration;
	const Belief& belief;

	Index intervals() const { return static_cast<Index>(imu.size()); }
	Eigen::Matrix3d phiJacobian(Index k) const
	{
		return imu[static_cast<size_t>(k)].biasJacobian().block<3, 3>(StateOrder::phi, kGyroColumn);
	}
	Eigen::Matrix3d phiCovariance(Index k) const
	{
		return imu[static_cast<size_t>(k)].covariance().block<3, 3>(StateOrder::phi, StateOrder::phi);
	}
};

Eigen::Vector3d visionError(const Inputs& in, Index k)
{
	const auto i = static_cast<size_t>(k);
	const Eigen::Quaterniond R_BC = in.calibration.T_BC().R;
	const Eigen::Quaterniond R_b_next = R_BC * in.sfm.T_c0_ck[i].R.conjugate() * in.sfm.T_c0_ck[i + 1].R * R_BC.conjugate();
	return so3::log(Eigen::Quaterniond(in.imu[i].delta().gamma.conjugate() * R_b_next));
}

/** In O's axes. */
Eigen::Vector3d wheelError(const Inputs& in, Index k)
{
	const auto i = static_cast<size_t>(k);
	const Eigen::Quaterniond R_OB = in.calibration.T_OB.R;
	return so3::log(Eigen::Quaterniond((R_OB * in.imu[i].delta().gamma * R_OB.conjugate()).conjugate() * in.wheels[i].dR()));
}

Rows weightedRows(const Inputs& in)
{
	const Index n = in.intervals(), m = in.wheels.empty() ? 0 : n;
	const Eigen::Matrix3d R_BC = in.calibration.T_BC().R.toRotationMatrix();
	const Eigen::RowVector3d z = in.calibration.T_OB.R.toRotationMatrix().row(2);  // O's z in B
	Rows rows{Eigen::VectorXd(3 * n + m), Eigen::MatrixXd(3 * n + m, 3), Eigen::MatrixXd::Zero(3 * n + m, 3 * n + m)};
	Eigen::MatrixXd intrinsics = Eigen::MatrixXd::Zero(3 * n + m, 3);
	for (Index k = 0; k < n; ++k)
	{
		rows.r.segment<3>(3 * k) = visionError(in, k);
		rows.J.middleRows<3>(3 * k) = in.phiJacobian(k);
		for (Index j = 0; j < n; ++j)
			rows.covariance.block<3, 3>(3 * k, 3 * j) =
			    R_BC * in.sfm.interval_covariance.block<3, 3>(6 * k + 3, 6 * j + 3) * R_BC.transpose();
		rows.covariance.block<3, 3>(3 * k, 3 * k) += in.phiCovariance(k);
		if (m == 0) continue;
		const WheelPreintegration& wheel = in.wheels[static_cast<size_t>(k)];
		const Index w = 3 * n + k;
		rows.r[w] = wheelError(in, k).z();
		rows.J.row(w) = z * in.phiJacobian(k);
		rows.covariance(w, w) = wheel.covariance()(5, 5) + (z * in.phiCovariance(k) * z.transpose()).value();
		rows.covariance.block<1, 3>(w, 3 * k) = z * in.phiCovariance(k);
		rows.covariance.block<3, 1>(3 * k, w) = in.phiCovariance(k) * z.transpose();
		intrinsics.row(w) = wheel.intrinsicsJacobian().row(5);
	}
	if (m > 0) rows.covariance += intrinsics * in.belief.wheels_covariance * intrinsics.transpose();
	return rows;
}

GyroBiasResult solve(const Rows& rows)
{
	const Eigen::LLT<Eigen::MatrixXd> noise(rows.covariance);
	const Eigen::MatrixXd J = noise.matrixL().solve(rows.J);
	const Eigen::VectorXd r = noise.matrixL().solve(rows.r);
	GyroBiasResult result;
	result.covariance = (J.transpose() * J).inverse();
	result.b_g = result.covariance * (J.transpose() * r);
	result.chi2_per_dof = (r - J * result.b_g).squaredNorm() / static_cast<double>(std::max<Index>(1, r.size() - 3));
	return result;
}

/** Unweighted estimate from three rows an interval, vision's or the wheels'. */
Eigen::Vector3d plainCorrection(const Inputs& in, bool from_wheels)
{
	const Eigen::Matrix3d R_BO = in.calibration.T_OB.R.conjugate().toRotationMatrix();
	Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
	Eigen::Vector3d b = Eigen::Vector3d::Zero();
	for (Index k = 0; k < in.intervals(); ++k)
	{
		const Eigen::Matrix3d J = in.phiJacobian(k);
		A += J.transpose() * J;
		b += J.transpose() * (from_wheels ? Eigen::Vector3d(R_BO * wheelError(in, k)) : visionError(in, k));
	}
	return A.ldlt().solve(b);
}

void repropagateAll(std::vector<ImuPreintegration>& imu, const Eigen::Vector3d& b_g)
{
	for (ImuPreintegration& interval : imu) interval.repropagate(interval.b_a(), b_g);
}
}  // namespace

GyroBiasResult alignGyroBias(const SfmResult& sfm, std::vector<ImuPreintegration>& imu, const std::vector<WheelPreintegration>& wheels,
                             const Calibration& calibration, const Belief& belief, const InitializerOptions& options)
{
	const Inputs in{sfm, imu, wheels, calibration, belief};
	GyroBiasResult result;
	Eigen::Vector3d b_g = imu.front().b_g();
	repropagateAll(imu, b_g);
	for (int round = 0; round < kRounds; ++round)
	{
		result = solve(weightedRows(in));
		const bool mean = options.gyro_bias == GyroBiasMethod::paper_mean && !wheels.empty();
		b_g += mean ? Eigen::Vector3d(0.5 * (plainCorrection(in, false) + plainCorrection(in, true))) : result.b_g;
		repropagateAll(imu, b_g);
	}
	result.b_g = b_g;
	return result;
}
}  // namespace viwo
