#include "calibration/BatchIntervals.h"

#include "ImuPreintegration.h"
#include "OnlineCalibration.h"
#include "StateOrder.h"
#include "TimeShift.h"
#include "WheelPreintegration.h"
#include "residuals/ExtendedResidual.h"
#include "residuals/ImuResidual.h"
#include "residuals/WheelResidual.h"

#include <viwo/core/So3.h>

#include <optional>

namespace viwo
{
namespace
{
using SensitivityJacobian = Eigen::Matrix<double, 15, ImuSensitivity::size>;

ImuPreintegration integrate(const std::vector<ImuSample>& measured, const ImuSensitivity& sensitivity, const ImuNoise& noise,
                            const NavState& at)
{
	std::vector<ImuSample> span;
	span.reserve(measured.size());
	for (const ImuSample& s : measured) span.push_back(sensitivity.corrected(s));
	ImuPreintegration result(noise, at.b_a, at.b_g);
	result.integrate(span);
	return result;
}

/** What the residual's first rows [alpha, phi, beta] owe to each entry of the sensitivity, by differences. */
SensitivityJacobian sensitivityJacobian(const std::vector<ImuSample>& measured, const ImuSensitivity& sensitivity, const ImuNoise& noise,
                                        const NavState& at, const ImuDelta& here)
{
	constexpr double kStep = 1e-3;
	SensitivityJacobian J = SensitivityJacobian::Zero();
	for (int i = 0; i < ImuSensitivity::size; ++i)
	{
		ImuSensitivity other = sensitivity;
		other.entries[static_cast<size_t>(i)] += kStep;
		const ImuPreintegration moved = integrate(measured, other, noise, at);
		const ImuDelta& there = moved.delta();
		J.col(i).segment<3>(StateOrder::p) = -(there.alpha - here.alpha) / kStep;
		J.col(i).segment<3>(StateOrder::phi) = -so3::log(Eigen::Quaterniond(here.gamma.conjugate() * there.gamma)) / kStep;
		J.col(i).segment<3>(StateOrder::v) = -(there.beta - here.beta) / kStep;
	}
	return J;
}

void cutImu(const BatchSamples& samples, const EstimatorOptions& options, const BatchStates& states, const Frame& before, Frame& frame)
{
	frame.interval.imu.reset();
	frame.imu_factor.reset();
	const auto span = samples.imu.span(states.imuTime_ns(before), states.imuTime_ns(frame), options.window.max_imu_gap_s);
	if (!span) return;
	const NavState at = before.state();
	frame.interval.imu = std::make_shared<ImuPreintegration>(integrate(*span, states.sensitivity, options.noise.imu, at));
	const ImuPreintegration& imu = *frame.interval.imu;
	const ImuTimeShift shift{significantShiftJacobian(imu), states.camera_offset_s[0]};
	const auto base = std::make_shared<ImuResidual>(imu, options.noise.gravity_m_s2, shift);
	const SensitivityJacobian J = sensitivityJacobian(*span, states.sensitivity, options.noise.imu, at, imu.delta());
	const Eigen::Map<const Eigen::VectorXd> here(states.sensitivity.entries.data(), ImuSensitivity::size);
	frame.imu_factor = std::make_shared<ExtendedResidual>(base, base->whiteningFactor() * J, here);
}

void cutWheels(const BatchSamples& samples, const EstimatorOptions& options, const WheelNoise& noise, const BatchStates& states,
               const Frame& before, Frame& frame)
{
	frame.interval.wheels.reset();
	frame.wheel_factor.reset();
	const auto segments = samples.wheels.segments(states.wheelTime_ns(before), states.wheelTime_ns(frame), options.window.max_wheel_gap_s);
	if (!segments) return;
	frame.interval.wheels = std::make_shared<WheelPreintegration>(noise, states.rig().wheels);
	for (const WheelSegment& s : *segments) frame.interval.wheels->integrate(s);
	const Pose3 T_OB = states.rig().T_BO.inverse();
	const WheelTimeShift shift{significantWheelShift(before, frame, T_OB), states.camera_offset_s[0] - states.wheel_offset_s[0]};
	frame.wheel_factor = std::make_shared<WheelResidual>(*frame.interval.wheels, shift);
}
}  // namespace

void cutIntervals(const BatchSamples& samples, const EstimatorOptions& options, double wheel_noise_ratio, BatchStates& states)
{
	WheelNoise noise = options.noise.wheels;
	noise.s0_m_s_sqrtHz *= wheel_noise_ratio;
	noise.k_sqrtHz *= wheel_noise_ratio;
	for (size_t i = 1; i < states.frames.size(); ++i)
	{
		const Frame& before = states.frames[i - 1];
		Frame& frame = states.frames[i];
		cutImu(samples, options, states, before, frame);
		cutWheels(samples, options, noise, states, before, frame);
	}
}
}  // namespace viwo
