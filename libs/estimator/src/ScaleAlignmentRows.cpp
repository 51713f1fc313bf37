#include "ScaleAlignmentRows.h"

#include <viwo/core/So3.h>

#include "StateOrder.h"

namespace viwo
{
ScaleAlignmentRows::ScaleAlignmentRows(const std::vector<Pose3>& T_c0_ck, const std::vector<ImuPreintegration>& imu,
                                       const std::vector<WheelPreintegration>& wheels, const Calibration& calibration, const Belief& belief)
    : T_c0_ck_(T_c0_ck),
      imu_(imu),
      wheels_(wheels),
      belief_(belief),
      n_(static_cast<Index>(imu.size())),
      rows_per_interval_(wheels.empty() ? 6 : 9),
      R_BC_(calibration.T_BC().R.toRotationMatrix()),
      R_BO_(calibration.T_BO().R.toRotationMatrix()),
      p_BC_(calibration.T_BC().p),
      p_BO_(calibration.T_BO().p)
{
}

Eigen::Vector3d ScaleAlignmentRows::visionStep_b(Index k) const
{
	const auto i = static_cast<size_t>(k);
	return R_b_c0(k) * (T_c0_ck_[i + 1].p - T_c0_ck_[i].p);
}

void ScaleAlignmentRows::system(const Eigen::Vector3d& nominal_g_c0, const Eigen::MatrixXd& basis, Eigen::MatrixXd& A,
                                Eigen::VectorXd& b) const
{
	const Index s = scaleColumn(), g = s + 1, m = basis.cols();
	const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
	A = Eigen::MatrixXd::Zero(rows(), g + m);
	b = Eigen::VectorXd::Zero(rows());
	for (Index k = 0; k < n_; ++k)
	{
		const ImuPreintegration& imu = imu_[static_cast<size_t>(k)];
		const double dt = imu.dt_s();
		const Eigen::Matrix3d R_next = R_b_next(k), R_g = R_b_c0(k);
		const Index i = rows_per_interval_ * k;

		// Niu et al. Eq. 11, camera and IMU
		A.block<3, 1>(i, s) = visionStep_b(k);
		A.block<3, 3>(i, 3 * k) = -dt * I;
		A.block(i, g, 3, m) = 0.5 * dt * dt * R_g * basis;
		b.segment<3>(i) = imu.delta().alpha + R_next * p_BC_ - p_BC_ - 0.5 * dt * dt * R_g * nominal_g_c0;

		A.block<3, 3>(i + 3, 3 * k) = -I;
		A.block<3, 3>(i + 3, 3 * k + 3) = R_next;
		A.block(i + 3, g, 3, m) = dt * R_g * basis;
		b.segment<3>(i + 3) = imu.delta().beta - dt * R_g * nominal_g_c0;

		if (wheels_.empty()) continue;
		// Eq. 12, camera and wheels
		A.block<3, 1>(i + 6, s) = visionStep_b(k);
		b.segment<3>(i + 6) = R_BO_ * wheels_[static_cast<size_t>(k)].dp() + (p_BO_ - p_BC_) - R_next * (p_BO_ - p_BC_);
	}
}

Eigen::MatrixXd ScaleAlignmentRows::visionJacobian(const Eigen::VectorXd& x, const Eigen::Vector3d& g_c0) const
{
	const double scale = x[scaleColumn()];
	Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows(), 6 * n_);
	for (Index k = 0; k < n_; ++k)
	{
		const double dt = imu_[static_cast<size_t>(k)].dt_s();
		const Eigen::Matrix3d R_next = R_b_next(k);
		const Index i = rows_per_interval_ * k;
		J.block<3, 3>(i, 6 * k) = scale * R_BC_;
		J.block<3, 3>(i, 6 * k + 3) = R_next * so3::skew(p_BC_) * R_BC_;
		J.block<3, 3>(i + 3, 6 * k + 3) = -R_next * so3::skew(x.segment<3>(3 * k + 3)) * R_BC_;
		if (!wheels_.empty())
		{
			J.block<3, 3>(i + 6, 6 * k) = scale * R_BC_;
			J.block<3, 3>(i + 6, 6 * k + 3) = -R_next * so3::skew(p_BO_ - p_BC_) * R_BC_;
		}
		// The turn from c0 to ck is the product of the intervals' turns: gravity in b_k feels the errors of all of them.
		const Eigen::Matrix3d tilt = R_BC_ * so3::skew(R_c0_c(k).transpose() * g_c0);
		for (Index j = 0; j < k; ++j)
		{
			const Eigen::Matrix3d R_k_j1 = R_c0_c(k).transpose() * R_c0_c(j + 1);
			J.block<3, 3>(i, 6 * j + 3) += 0.5 * dt * dt * tilt * R_k_j1;
			J.block<3, 3>(i + 3, 6 * j + 3) += dt * tilt * R_k_j1;
		}
	}
	return J;
}

Eigen::MatrixXd ScaleAlignmentRows::sensorCovariance() const
{
	Eigen::MatrixXd S = Eigen::MatrixXd::Zero(rows(), rows());
	Eigen::MatrixXd J_b_a = Eigen::MatrixXd::Zero(rows(), 3), J_wheels = Eigen::MatrixXd::Zero(rows(), 3);
	constexpr int p = StateOrder::p, v = StateOrder::v;
	for (Index k = 0; k < n_; ++k)
	{
		const ImuPreintegration& imu = imu_[static_cast<size_t>(k)];
		const Index i = rows_per_interval_ * k;
		S.block<3, 3>(i, i) += imu.covariance().block<3, 3>(p, p);
		S.block<3, 3>(i, i + 3) += imu.covariance().block<3, 3>(p, v);
		S.block<3, 3>(i + 3, i) += imu.covariance().block<3, 3>(v, p);
		S.block<3, 3>(i + 3, i + 3) += imu.covariance().block<3, 3>(v, v);
		J_b_a.middleRows<3>(i) = imu.biasJacobian().block<3, 3>(p, 0);
		J_b_a.middleRows<3>(i + 3) = imu.biasJacobian().block<3, 3>(v, 0);
		if (wheels_.empty()) continue;
		const WheelPreintegration& wheel = wheels_[static_cast<size_t>(k)];
		S.block<3, 3>(i + 6, i + 6) += R_BO_ * wheel.covariance().topLeftCorner<3, 3>() * R_BO_.transpose();
		J_wheels.middleRows<3>(i + 6) = R_BO_ * wheel.intrinsicsJacobian().topRows<3>();
	}
	S += J_b_a * belief_.bias_covariance.topLeftCorner<3, 3>() * J_b_a.transpose();
	if (!wheels_.empty()) S += J_wheels * belief_.wheels_covariance * J_wheels.transpose();
	return S;
}

Eigen::Vector3d ScaleAlignmentRows::meanSpecificForce_c0() const
{
	Eigen::Vector3d sum = Eigen::Vector3d::Zero();
	double duration_s = 0;
	for (Index k = 0; k < n_; ++k)
	{
		sum += R_b_c0(k).transpose() * imu_[static_cast<size_t>(k)].delta().beta;
		duration_s += imu_[static_cast<size_t>(k)].dt_s();
	}
	return sum / duration_s;
}
}  // namespace viwo
