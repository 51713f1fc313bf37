#pragma once

#include "RosBagFile.h"
#include "RosMessages.h"

#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** The vehicle's motion out of the joints of its wheels, the messages of a topic sensor_msgs/JointState in the order of their stamps.
 *
 *  From the change of the positions since the message before, so the mean since then, or, where a message has no positions, from its
 *  velocities. Positions that stay within one turn are unwrapped. A step that is far longer and faster than those around it (a counter set
 *  anew) gives no sample. */
class RosWheels
{
   public:
	RosWheels() = default;
	/** @throws Error: no message of the topic has all joints that the map names, with a value of each. It lists those that are there. */
	RosWheels(const RosBagFile& bag, const TopicMapping& mapping, bool record_time);

	const std::vector<StampedTwist>& samples() const { return samples_; }
	/** Nothing for the first positions, for a message without these joints, and where they jump. */
	std::optional<WheelTwist> at(int64_t t_ns) const;
	/** What was mended or left out. */
	std::vector<std::string> notes() const;

   private:
	/** Values of the left joints, then of the right ones. */
	struct Reading
	{
		int64_t t_ns;
		std::vector<double> values;
	};

	void read(const RosBagFile& bag, const TopicMapping& mapping, bool record_time);
	void sortByStamp(std::vector<Reading>& readings);
	void unwrapTurns();
	std::vector<bool> findJumps(double wheel_radius_m) const;
	void addSamples(const TopicMapping& mapping);

	std::vector<Reading> angles_rad_, rates_rad_s_;
	size_t left_joints_ = 0;
	std::vector<StampedTwist> samples_;
	size_t same_stamp_ = 0, unwrapped_ = 0, jumps_ = 0;
};
}  // namespace viwo
