#pragma once

#include "RosBagFile.h"
#include "RosMessages.h"

namespace viwo
{
/** @throws Error: no message of the topic has all joints that the map names, with a value of each. It lists those that are there. */
void requireWheels(const RosBagFile& bag, const TopicMapping& mapping);

/** Joints of the wheels to the vehicle's motion. */
class RosWheels
{
   public:
	/** Of a sensor_msgs/JointState: from the change of the positions since the message before, so the mean since then, or, where joints
	 * have no positions, from their velocities. @return nothing for the first positions, and for a message without these joints. */
	std::optional<StampedTwist> push(const rosbag::MessageInstance& message, int64_t t_ns, const TopicMapping& mapping);

   private:
	struct Angles
	{
		int64_t t_ns;
		double left_rad, right_rad;
	};
	std::optional<Angles> last_;
};
}  // namespace viwo
