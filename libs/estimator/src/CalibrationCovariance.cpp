#include "CalibrationCovariance.h"

#include "OnlineCalibration.h"
#include "StateOrder.h"
#include "WindowSolver.h"

#include <cmath>
#include <vector>

namespace viwo
{
namespace
{
constexpr Eigen::Index kBiases = StateOrder::b_a - StateOrder::v, kMotion = StateOrder::size - StateOrder::v;

/** Position along O's axes, rotation about them. z of O is held. */
Eigen::Matrix<double, 6, 1> mountingDeviations(const Belief::Matrix6& covariance, const Pose3& T_BO)
{
	const Eigen::Matrix3d R_OB = T_BO.R.conjugate().toRotationMatrix();
	Eigen::Matrix<double, 6, 1> variances = covariance.diagonal();
	variances.head<3>() = (R_OB * covariance.topLeftCorner<3, 3>() * R_OB.transpose()).diagonal();
	return variances.cwiseSqrt();
}

/** Rotations are perturbed about O's axes: yaw, which starts first, is the last. */
Belief::Matrix6 ofFreeParts(const Belief::Matrix6& found, const Belief::Matrix6& believed, const CalibrationFreedom& freedom)
{
	if (freedom.yaw && freedom.lever_arm && freedom.tilt) return found;
	Belief::Matrix6 mixed = believed;
	if (!freedom.yaw) return mixed;
	constexpr Eigen::Index yaw = 5;
	mixed.row(yaw).setZero();
	mixed.col(yaw).setZero();
	mixed(yaw, yaw) = found(yaw, yaw);
	return mixed;
}

CalibrationCovariance covarianceOf(const Belief& belief, const EstimatorOptions& o)
{
	CalibrationCovariance c;
	c.biases = belief.bias_covariance;
	if (o.useCamera()) c.T_BC = belief.T_BC_covariance;
	if (o.useWheelFactor()) c.wheels = belief.wheels_covariance;
	if (o.calibratesWheels()) c.T_BO = belief.T_BO_covariance, c.t_w_s2 = belief.t_w_variance_s2;
	if (o.calibratesWheels() || o.freeCameraOffset()) c.t_d_s2 = belief.t_d_variance_s2;
	return c;
}
}  // namespace

std::optional<CalibrationCovariance> calibrationCovariance(Window& w)
{
	const EstimatorOptions& o = w.options;
	CalibrationCovariance result = covarianceOf(w.belief, o);  // for what there is of it
	std::vector<double*> blocks{w.latest().motion.data()};
	if (result.T_BC) blocks.push_back(w.T_BC.data());
	if (result.wheels) blocks.push_back(w.wheels.data());
	if (result.T_BO) blocks.push_back(w.T_BO.data());
	if (result.t_d_s2) blocks.push_back(&w.t_d_s);
	if (result.t_w_s2) blocks.push_back(&w.t_w_s);
	Eigen::MatrixXd joint;
	if (!marginalCovariance(w, blocks, joint)) return std::nullopt;

	result.biases = joint.block<6, 6>(kBiases, kBiases);
	Eigen::Index next = kMotion;
	const auto take = [&](auto& target)
	{
		if (!target) return;
		const Eigen::Index size = target->rows();
		*target = joint.block(next, next, size, size);
		next += size;
	};
	take(result.T_BC);
	take(result.wheels);
	take(result.T_BO);
	if (result.t_d_s2) result.t_d_s2 = joint(next, next), ++next;
	if (result.t_w_s2) result.t_w_s2 = joint(next, next);

	// What is held has not moved to where the measurements would have it, and is as sure as it was.
	const CalibrationFreedom freedom = freedomOf(w);
	if (result.T_BO) *result.T_BO = ofFreeParts(*result.T_BO, w.belief.T_BO_covariance, freedom);
	if (result.t_d_s2 && !freedom.camera_offset) result.t_d_s2 = w.belief.t_d_variance_s2;
	if (result.t_w_s2 && !freedom.wheel_offset) result.t_w_s2 = w.belief.t_w_variance_s2;
	return result;
}

Belief learnedBelief(Window& w)
{
	Belief learned = w.belief;
	learned.excitation = w.excitation;
	const std::optional<CalibrationCovariance> covariance = calibrationCovariance(w);
	if (!covariance) return learned;

	const NavState state = w.latest().state();
	learned.found_ns = state.t_ns;
	learned.b_a = state.b_a;
	learned.b_g = state.b_g;
	learned.bias_covariance = covariance->biases;
	if (covariance->T_BC)
	{
		learned.T_BC = w.T_BC_pose();
		learned.T_BC_covariance = *covariance->T_BC;
	}
	if (covariance->wheels)
	{
		learned.wheels = w.wheelIntrinsics();
		learned.wheels_covariance = *covariance->wheels;
	}
	if (covariance->T_BO)
	{
		learned.T_BO = w.T_BO_pose();
		learned.T_BO_covariance = *covariance->T_BO;
	}
	learned.offsets = w.offsets();
	if (covariance->t_d_s2) learned.t_d_variance_s2 = *covariance->t_d_s2;
	if (covariance->t_w_s2) learned.t_w_variance_s2 = *covariance->t_w_s2;
	return learned;
}

CalibrationDeviations calibrationDeviations(Window& w, bool running)
{
	const EstimatorOptions& o = w.options;
	CalibrationCovariance c = covarianceOf(w.belief, o);
	if (running)
		if (const auto found = calibrationCovariance(w)) c = *found;
	CalibrationDeviations d;
	const CalibrationFreedom freedom = freedomOf(w);
	if (c.T_BC && o.factors.estimate_T_BC) d.T_BC = c.T_BC->diagonal().cwiseSqrt();
	if (c.wheels && o.factors.estimate_wheel_intrinsics) d.wheels = c.wheels->diagonal().cwiseSqrt();
	if (o.freeMounting()) d.T_BO = mountingDeviations(*c.T_BO, w.T_BO_pose());
	if (o.freeCameraOffset()) d.camera_time_offset_s = std::sqrt(*c.t_d_s2);
	if (o.freeWheelOffset()) d.wheel_time_offset_s = std::sqrt(*c.t_w_s2);
	d.lever_arm_started = freedom.lever_arm;
	d.yaw_started = freedom.yaw;
	d.camera_offset_started = freedom.camera_offset;
	d.wheel_offset_started = freedom.wheel_offset;
	return d;
}
}  // namespace viwo
