#pragma once

#include <viwo/core/ImuSample.h>
#include <viwo/core/NavState.h>

#include <vector>

#include "ClockOffsets.h"

namespace viwo
{
class ImuPreintegration;

/** Strapdown integration over samples that begin at the state's time: one state per sample after the first, rates and forces held at their
 * mean between two of them.
 */
std::vector<NavState> propagateOver(NavState state, const std::vector<ImuSample>& samples, double gravity_m_s2);

/** The state at the end of an interval that begins at `state`; its stamp is left to the caller. */
NavState predict(const NavState& state, const ImuPreintegration& interval, double gravity_m_s2);

/** R_Bfirst_Blast over the samples. */
Eigen::Quaterniond turnOver(const std::vector<ImuSample>& samples, const Eigen::Vector3d& b_g);

/** Whether a robot can have this state: it is finite, and neither velocity nor biases are out of this world. */
bool plausible(const NavState& state);
/** Whether clocks can be so far apart: no further than samples are kept. */
bool plausible(const ClockOffsets& offsets);
}  // namespace viwo
