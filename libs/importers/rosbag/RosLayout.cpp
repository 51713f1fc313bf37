#include "RosLayout.h"

#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <viwo/core/Error.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace viwo
{
namespace
{
/** Types with arrays, up to the last of them. A digit group is that many bytes; s: a string; a8: an array of elements of 8 bytes;
 *  (...): an array of what stands inside. A header is "12 s". */
const std::map<std::string, const char*>& layouts()
{
	static const std::map<std::string, const char*> known = {
	    {"sensor_msgs/Image", "12s8s5a1"},          {"sensor_msgs/CompressedImage", "12ssa1"},
	    {"sensor_msgs/CameraInfo", "12s8sa8"},      {"sensor_msgs/LaserScan", "12s28a4a4"},
	    {"sensor_msgs/JointState", "12s(s)a8a8a8"}, {"sensor_msgs/PointCloud2", "12s8(s9)9a1"},
	    {"tf2_msgs/TFMessage", "(12ss56)"},         {"tf/tfMessage", "(12ss56)"}};
	return known;
}

/** Walks through the bytes of a message as its layout says. */
class Walk
{
   public:
	explicit Walk(const std::vector<uint8_t>& bytes) : bytes_(bytes) {}

	/** @return false where the bytes end too early. */
	bool along(const char* layout)
	{
		while (*layout != '\0' && *layout != ')')
			if (!step(layout)) return false;
		return true;
	}

   private:
	/** One item, and `layout` behind it. */
	bool step(const char*& layout)
	{
		if (*layout == 's') return ++layout, array(1);
		if (*layout == 'a') return ++layout, array(number(layout));
		if (*layout != '(') return skip(number(layout));
		const char* const inside = layout + 1;
		layout = std::strchr(inside, ')') + 1;
		uint32_t count = 0;
		if (!length(count)) return false;
		for (uint32_t i = 0; i < count; ++i)
			if (!along(inside)) return false;
		return true;
	}

	static uint64_t number(const char*& layout)
	{
		uint64_t value = 0;
		for (; *layout >= '0' && *layout <= '9'; ++layout) value = 10 * value + static_cast<uint64_t>(*layout - '0');
		return value;
	}

	bool array(uint64_t element_bytes)
	{
		uint32_t count = 0;
		return length(count) && skip(element_bytes * count);
	}

	bool length(uint32_t& count)
	{
		if (at_ + sizeof count > bytes_.size()) return false;
		std::memcpy(&count, bytes_.data() + at_, sizeof count);
		at_ += sizeof count;
		return true;
	}

	bool skip(uint64_t n)
	{
		at_ += n;
		return at_ <= bytes_.size();
	}

	const std::vector<uint8_t>& bytes_;
	uint64_t at_ = 0;
};
}  // namespace

void requireSoundLengths(const rosbag::MessageInstance& message)
{
	const auto layout = layouts().find(message.getDataType());
	if (layout == layouts().end()) return;
	std::vector<uint8_t> bytes(message.size());
	ros::serialization::OStream stream(bytes.data(), static_cast<uint32_t>(bytes.size()));
	message.write(stream);
	if (!Walk(bytes).along(layout->second))
		throw Error(message.getTopic() + ": a " + message.getDataType() + " of " + std::to_string(bytes.size()) +
		            " bytes is shorter than the lengths in it: damaged; copy the bag again, or leave the topic out by a --map");
}
}  // namespace viwo
