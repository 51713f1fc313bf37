#pragma once

#include "Window.h"

namespace viwo
{
/** What became of the second-latest frame once its successor was there (paper Sec. 6.3, Fig. 3). */
enum class Fate
{
	kept_growing,              //!< keyframe, and there was room
	kept_oldest_marginalized,  //!< keyframe: the oldest left with all its measurements
	merged,                    //!< no keyframe: its images and plane were dropped, its IMU and wheels joined to the next interval
	kept_timed                 //!< the robot stands: kept so that no interval grows too long; the one kept before it was marginalised
};

/** Makes room for the next frame. Called after the window was solved. */
Fate advanceWindow(Window& window);

/** Before the start: keeps the number of waiting frames that of a full window, and of frames without parallax the newest only. */
void thinOutWaitingFrames(Window& window);

/** Before a start from wheels: once they speak, the frames from before that are of no use to it. */
void dropFramesBeforeWheels(Window& window);

/** VINS-Mono's rule: mean parallax against the keyframe before it, rotation removed, or too few tracks in common. */
bool isKeyframe(const Window& window, const Frame& frame, const Frame& previous);

/** Takes states out of the problem: all factors that touch them become part of the linear prior on their neighbours. */
void marginalizeBlocks(Window& window, const std::vector<double*>& blocks);
}  // namespace viwo
