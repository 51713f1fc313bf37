#pragma once

#include "TimeShift.h"
#include "Window.h"

namespace viwo
{
/** Which of the calibration states of a window the solver may move. The factors tell marginalisation about all of them from the first frame
 * on, so that nothing measured before is lost, or said twice, when one is released.
 */
struct CalibrationFreedom
{
	bool lever_arm = false, tilt = false, yaw = false;  //!< of T_BO
	bool camera_offset = false, wheel_offset = false;

	bool mounting() const { return lever_arm || tilt || yaw; }
};

/** What is switched on, and has been excited by the motion. */
CalibrationFreedom freedomOf(const Window& window);

/** Adds what the motion over a keyframe's final interval shows. @param camera_tracks or there is none. */
void noteExcitation(Window& window, const Frame& before, const Frame& keyframe, bool camera_tracks);

/** Of a wheel interval, with the motion at its ends as the states and the gyro have it. Zero where speed or turn rate do not change by more
 * than they are known.
 */
WheelTimeShift::Jacobian significantWheelShift(const Frame& before, const Frame& after, const Pose3& T_OB);

/** Whether any wheel turned. One that did not says nothing of how it is mounted, however sure it is that it stood. */
bool rolled(const WheelPreintegration& wheels);
}  // namespace viwo
