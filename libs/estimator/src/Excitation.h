#pragma once

namespace viwo
{
/** What of a motion can show how sensors sit and how their clocks go, summed over the keyframes' intervals. A calibration parameter is held
 * where it is until there is enough of its kind.
 */
struct Excitation
{
	double travel_m = 0;                //!< by the wheels, while the camera tracks: heading of the wheels against camera and IMU
	double turned_rad = 0;              //!< to and fro: lever arms, and the axis about which the robot turns
	double turn_rate_change_rad_s = 0;  //!< to and fro: clocks
	double speed_change_m_s = 0;        //!< to and fro: clocks of the wheels
};
}  // namespace viwo
