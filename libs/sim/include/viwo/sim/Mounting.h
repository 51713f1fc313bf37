#pragma once

#include <viwo/core/Pose3.h>

#include <vector>

namespace viwo::sim
{
/** Pose of a sensor in O from "x y z yaw pitch roll", metres and degrees in MRPT's order (R = Rz Ry Rx). @throws Error unless six numbers.
 */
Pose3 mountingPose(const std::vector<double>& x_y_z_m_yaw_pitch_roll_deg, const char* key);

/** The pose that is published, and the one where the sensor really sits: nominal, then displaced by `error` in the sensor's own frame. */
struct Mounting
{
	Pose3 nominal, actual;

	Mounting(const std::vector<double>& pose, const std::vector<double>& error, const char* section);
};
}  // namespace viwo::sim
