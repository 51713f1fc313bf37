#pragma once

#include <viwo/core/Time.h>

#include <cstdint>

namespace viwo
{
/** Clocks against the IMU's: t_IMU = t_CAM + t_d = t_WHEEL + t_w. Frames have stamps of the camera's clock. */
struct ClockOffsets
{
	double t_d_s = 0, t_w_s = 0;

	int64_t imuTime(int64_t frame_ns) const { return frame_ns + nanoseconds(t_d_s); }
	int64_t wheelTime(int64_t frame_ns) const { return imuTime(frame_ns) - nanoseconds(t_w_s); }
	/** Of the frames' clock against the wheels', s. */
	double wheelShift_s() const { return t_d_s - t_w_s; }
};
}  // namespace viwo
