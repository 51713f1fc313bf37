#pragma once

#include <viwo/core/FeatureFrame.h>
#include <viwo/core/NavState.h>

#include <array>
#include <cstdint>
#include <memory>

#include "ClockOffsets.h"

namespace viwo
{
class ImuPreintegration;
class WheelPreintegration;
class LocalCost;

/** What the sensors say of the motion between two frames; either may be missing. */
struct Interval
{
	std::shared_ptr<ImuPreintegration> imu;
	std::shared_ptr<WheelPreintegration> wheels;
	ClockOffsets cut_at;  //!< by which the frames' times were turned into those of the sensors
};

/** One frame of the window: its state as solver blocks, its tracks, and the interval that leads to it. */
struct Frame
{
	int64_t id = 0;  //!< counts frames; never used again
	int64_t t_ns = 0;
	std::array<double, 7> pose{};    //!< T_WB: p, quaternion x y z w
	std::array<double, 9> motion{};  //!< v_WB, b_a, b_g
	FeatureFrame features;
	Interval interval;  //!< from the frame before it in the window
	bool keyframe = false;
	bool timed = false;  //!< kept only so that no interval grows too long
	bool standing = false;

	// Whitening costs a factorisation, so a factor lives as long as its measurement; reset where that changes.
	std::shared_ptr<LocalCost> imu_factor, wheel_factor, plane_factor, standstill_factor;

	NavState state() const;
	void setState(const NavState& state);
};
}  // namespace viwo
