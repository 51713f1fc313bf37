#pragma once

namespace rosbag
{
class MessageInstance;
}

namespace viwo
{
/** ROS makes room for as many elements of an array as a message says, before it looks whether the message has them: damaged lengths would
 *  take all memory. @throws Error where a message of a known type is shorter than the lengths in it. */
void requireSoundLengths(const rosbag::MessageInstance& message);
}  // namespace viwo
