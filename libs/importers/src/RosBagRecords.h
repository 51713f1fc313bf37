#pragma once

#include <string>

namespace viwo
{
/** Walks over the records of a bag of format 2.0 without its messages: each must lie within the file or its chunk, and the index must point
 *  at messages. The ROS library believes these numbers, and with wrong ones reads outside of its memory. Inside of compressed chunks,
 * which have check sums of their own, nothing is looked at.
 *  @throws Error: damaged, with the place in the file. */
void requireSoundRecords(const std::string& path);
}  // namespace viwo
