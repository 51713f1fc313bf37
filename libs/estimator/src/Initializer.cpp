#include "Initializer.h"

#include <viwo/core/So3.h>

namespace viwo
{
namespace
{
InitializerStatus statusOf(ScaleStatus status)
{
	switch (status)
	{
		case ScaleStatus::ok:
			return InitializerStatus::ok;
		case ScaleStatus::bad_gravity:
			return InitializerStatus::bad_gravity;
		case ScaleStatus::negative_scale:
			return InitializerStatus::negative_scale;
		case ScaleStatus::bad_residual:
			return InitializerStatus::bad_residual;
		case ScaleStatus::ill_conditioned:
			break;
	}
	return InitializerStatus::ill_conditioned;
}

Pose3 metric(const Pose3& T_c0_ck, double scale)
{
	return {T_c0_ck.R, scale * T_c0_ck.p};
}
}  // namespace

const char* toString(InitializerStatus status)
{
	switch (status)
	{
		case InitializerStatus::ok:
			return "ok";
		case InitializerStatus::no_reconstruction:
			return "no reconstruction";
		case InitializerStatus::bad_gyro_bias:
			return "gyroscope and vision do not fit";
		case InitializerStatus::ill_conditioned:
			return "scale not observable";
		case InitializerStatus::bad_gravity:
			return "specific force is not gravity";
		case InitializerStatus::negative_scale:
			return "negative scale";
		case InitializerStatus::bad_residual:
			return "IMU and wheels do not fit vision";
	}
	return "unknown";
}

InitializerResult Initializer::align(const SfmResult& sfm, std::vector<ImuPreintegration>& imu,
                                     const std::vector<WheelPreintegration>& wheels) const
{
	InitializerResult result;
	const bool matches = !imu.empty() && sfm.T_c0_ck.size() == imu.size() + 1 && (wheels.empty() || wheels.size() == imu.size());
	if (sfm.status != SfmStatus::ok || !matches) return result;

	result.gyro = alignGyroBias(sfm, imu, wheels, calibration_, belief_, options_);
	result.status = InitializerStatus::bad_gyro_bias;
	const bool plausible = result.gyro.b_g.norm() <= options_.max_gyro_bias_rad_s && result.gyro.chi2_per_dof <= options_.max_chi2_per_dof;
	if (!plausible) return result;

	result.alignment = alignScale(sfm, imu, wheels, calibration_, belief_, gravity_m_s2_, options_);
	result.status = statusOf(result.alignment.status);
	return result;
}

Pose3 Initializer::poseOfC0(const InitializerResult& result, size_t origin, const Pose3& T_WO_origin) const
{
	const Pose3 T_c0_O = metric(result.alignment.T_c0_ck[origin], result.alignment.scale) * calibration_.T_OC.inverse();
	const Eigen::Quaterniond level = Eigen::Quaterniond::FromTwoVectors(result.alignment.up_c0, Eigen::Vector3d::UnitZ());
	const double turn_rad = yawOf(T_WO_origin.R) - yawOf(level * T_c0_O.R);
	const Eigen::Quaterniond R_WC0 = (so3::expQuaternion({0, 0, turn_rad}) * level).normalized();
	return {R_WC0, T_WO_origin.p - R_WC0 * T_c0_O.p};
}

std::vector<NavState> Initializer::navStates(const InitializerResult& result, const std::vector<ImuPreintegration>& imu, size_t origin,
                                             const Pose3& T_WO_origin) const
{
	const Pose3 T_WC0 = poseOfC0(result, origin, T_WO_origin);
	std::vector<NavState> states;
	for (size_t k = 0; k < result.alignment.T_c0_ck.size(); ++k)
	{
		NavState state;
		const ImuPreintegration& interval = imu[std::min(k, imu.size() - 1)];
		state.t_ns = k < imu.size() ? interval.t_begin_ns() : interval.t_end_ns();
		state.T_WB = T_WC0 * metric(result.alignment.T_c0_ck[k], result.alignment.scale) * calibration_.T_BC().inverse();
		state.v_WB = state.T_WB.R * result.alignment.v_B[k];
		state.b_a = interval.b_a();
		state.b_g = result.gyro.b_g;
		states.push_back(state);
	}
	return states;
}

}  // namespace viwo
