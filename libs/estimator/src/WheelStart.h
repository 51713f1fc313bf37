#pragma once

#include "Window.h"

namespace viwo
{
class IntervalFactory;

/** Start without vision (Niu et al. Sec. 5 has none; it waits): wheels give motion and scale, the accelerometer and the floor the tilt,
 * wheels or standstill the gyro bias. The window's frames, each with IMU and wheel interval, get their states, with O of the latest frame
 * at T_WO (its roll and pitch are replaced by the measured ones), and the start priors.
 *  @return false when an interval is missing.
 */
bool startFromWheels(Window& window, IntervalFactory& intervals, const Pose3& T_WO_latest);

/** The priors that every start puts on the window: gauge on `gauge`, velocity of the oldest frame, its biases and the calibration by the
 * window's belief, floor.
 */
void addStartPriors(Window& window, Frame& gauge, double velocity_sigma_m_s);
}  // namespace viwo
