#include "calibration/BatchQuality.h"

#include "WheelPreintegration.h"
#include "residuals/BlockAlgebra.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

#include <cmath>
#include <map>

namespace viwo
{
namespace
{
struct MeanSquare
{
	double sum = 0, number = 0;

	void add(double value)
	{
		sum += square(value);
		++number;
	}
	double root() const { return number > 0 ? std::sqrt(sum / number) : 0; }
};

/** Errors of the sightings, px, by the frame's number. */
std::map<int64_t, MeanSquare> imageErrors(const BatchCalibrationInput& in, const BatchStates& states, const LandmarkMap& landmarks)
{
	std::map<int64_t, MeanSquare> errors;
	const Pose3 T_BC = poseFromBlock(states.T_BC.data());
	for (const auto& [id, landmark] : landmarks.all())
	{
		if (!landmark.in_use) continue;
		const Pose3 T_WC = poseFromBlock(landmark.anchor().pose.data()) * T_BC;
		const Eigen::Vector3d P_W = T_WC * Eigen::Vector3d(landmark.sightings.front().bearing_C.normalized() / landmark.inverse_depth_1_m);
		for (size_t i = 1; i < landmark.sightings.size(); ++i)
		{
			const Sighting& s = landmark.sightings[i];
			const Eigen::Vector3d P_C = (poseFromBlock(s.frame->pose.data()) * T_BC).inverse() * P_W;
			errors[s.frame->id].add((P_C.normalized() - s.bearing_C.normalized()).norm() * in.camera.meanFocal_px());
		}
	}
	return errors;
}

/** How O moved from frame to frame, less what the wheels say. */
void wheelErrors(const BatchStates& states, size_t i, CalibrationMisfit& misfit)
{
	const Frame& frame = states.frames[i];
	if (!frame.interval.wheels) return;
	const SensorRig rig = states.rig();
	const Pose3 T_WOi = poseFromBlock(states.frames[i - 1].pose.data()) * rig.T_BO, T_WOj = poseFromBlock(frame.pose.data()) * rig.T_BO;
	const Pose3 moved = T_WOi.inverse() * T_WOj, rolled = frame.interval.wheels->corrected(rig.wheels);
	const Eigen::Vector3d way_m = moved.p - rolled.p;
	misfit.wheel_forward_mm = 1e3 * way_m.x();
	misfit.wheel_sideways_mm = 1e3 * way_m.y();
	misfit.wheel_yaw_mrad = 1e3 * so3::log(Eigen::Quaterniond(rolled.R.conjugate() * moved.R)).z();
}
}  // namespace

CalibrationQuality qualityOf(const BatchCalibrationInput& input, const BatchStates& states, const LandmarkMap& landmarks)
{
	CalibrationQuality quality;
	std::map<int64_t, MeanSquare> images = imageErrors(input, states, landmarks);
	MeanSquare image, forward, sideways, yaw, reference;
	const Pose3 T_RW = poseFromBlock(states.T_RW.data()), T_BO = states.rig().T_BO;
	for (size_t i = 0; i < states.frames.size(); ++i)
	{
		const Frame& frame = states.frames[i];
		CalibrationMisfit misfit;
		misfit.t_s = secondsBetween(states.frames.front().t_ns, frame.t_ns);
		const MeanSquare& of_frame = images[frame.id];
		misfit.image_px = of_frame.root();
		image.sum += of_frame.sum;
		image.number += of_frame.number;
		if (i > 0) wheelErrors(states, i, misfit);
		forward.add(misfit.wheel_forward_mm);
		sideways.add(misfit.wheel_sideways_mm);
		yaw.add(misfit.wheel_yaw_mrad);
		quality.frames.push_back(misfit);
		if (input.reference.empty()) continue;
		const auto T_RO = input.reference.at(states.imuTime_ns(frame) + nanoseconds(states.reference_offset_s[0]), 0.5);
		if (T_RO) reference.add(1e3 * (T_RW * (poseFromBlock(frame.pose.data()) * T_BO).p - T_RO->p).head<2>().norm());
	}
	quality.image_px = image.root();
	quality.wheel_forward_mm = forward.root();
	quality.wheel_sideways_mm = sideways.root();
	quality.wheel_yaw_mrad = yaw.root();
	quality.reference_mm = reference.root();
	return quality;
}
}  // namespace viwo
