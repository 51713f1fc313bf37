#include "VisionStart.h"

#include "ImuPreintegration.h"
#include "Initializer.h"
#include "IntervalFactory.h"
#include "WheelPreintegration.h"
#include "WheelStart.h"

#include <viwo/sfm/StructureFromMotion.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace viwo
{
namespace
{
constexpr size_t kMinFrames = 6;
/** Velocities of the alignment are good to some part of themselves, and never better than this many of the start's own deviations. */
constexpr double kVelocityShare = 0.3;

SfmOptions sfmOptions(const Window& w)
{
	SfmOptions options;
	options.sigma_rad = w.options.noise.start_pixel_sigma_px / w.calibration.camera.meanFocal_px();
	return options;
}

std::vector<Eigen::Quaterniond> gyroRotations(const Window& w)
{
	std::vector<Eigen::Quaterniond> R_c0_ck{Eigen::Quaterniond::Identity()};
	const Eigen::Quaterniond R_BC = w.T_BC_pose().R;
	for (size_t i = 1; i < w.frames.size(); ++i)
		R_c0_ck.push_back((R_c0_ck.back() * R_BC.conjugate() * w.frames[i]->interval.imu->delta().gamma * R_BC).normalized());
	return R_c0_ck;
}

void applyStates(Window& w, const std::vector<NavState>& states)
{
	for (size_t i = 0; i < w.frames.size(); ++i) w.frames[i]->setState(states[i]);
}
}  // namespace

bool startFromVision(Window& w, IntervalFactory& intervals, const Pose3& T_WO_latest)
{
	if (w.frames.size() < kMinFrames) return false;
	bool all_wheels = w.options.useWheels();
	std::vector<FeatureFrame> features{w.frames.front()->features};
	std::vector<ImuPreintegration> imu;
	std::vector<WheelPreintegration> wheels;
	for (size_t i = 1; i < w.frames.size(); ++i)
	{
		const Frame& frame = *w.frames[i];
		if (!frame.interval.imu) return false;
		features.push_back(frame.features);
		imu.push_back(*frame.interval.imu);
		all_wheels = all_wheels && frame.interval.wheels;
	}
	const bool aligns_wheels = all_wheels && w.options.factors.wheels_in_initialization;
	for (size_t i = 1; i < w.frames.size() && aligns_wheels; ++i) wheels.push_back(*w.frames[i]->interval.wheels);

	const SfmResult sfm = StructureFromMotion(sfmOptions(w)).reconstruct(features, gyroRotations(w));
	if (sfm.status != SfmStatus::ok) return false;
	Calibration calibration = w.calibration;
	calibration.T_OC = calibration.T_OB * w.belief.T_BC;
	InitializerOptions options = w.options.initializer;
	// The wheel factors of the window will tell the scale: it need not be known here.
	if (all_wheels && w.options.factors.wheel_factor) options.max_scale_sigma_without_wheels = std::numeric_limits<double>::infinity();
	const Initializer initializer(calibration, w.belief, w.options.noise.gravity_m_s2, options);
	const InitializerResult aligned = initializer.align(sfm, imu, wheels);
	if (aligned.status != InitializerStatus::ok) return false;

	const std::vector<NavState> states = initializer.navStates(aligned, imu, w.frames.size() - 1, T_WO_latest);
	applyStates(w, states);
	intervals.relinearizeAt(w, w.belief.b_a, aligned.gyro.b_g);
	const double share = std::max(kVelocityShare, aligned.alignment.scale_sigma);
	const double velocity_sigma_m_s = std::max(w.options.priors.velocity_m_s, share * states.front().v_WB.norm());
	addStartPriors(w, w.latest(), velocity_sigma_m_s);
	return true;
}
}  // namespace viwo
