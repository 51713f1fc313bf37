#pragma once

#include "Window.h"

namespace viwo
{
class IntervalFactory;

/** Start with vision (Niu et al. Sec. 5): structure from motion of the waiting frames, aligned with IMU and (unless they are switched off)
 * wheels. The window's frames get their states, with O of the latest at T_WO (its roll and pitch are replaced by the measured ones), and
 * the start priors.
 *  @return false when the frames do not suffice yet.
 */
bool startFromVision(Window& window, IntervalFactory& intervals, const Pose3& T_WO_latest);
}  // namespace viwo
