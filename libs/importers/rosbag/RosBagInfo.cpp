#include "RosBagSources.h"
#include "StreamStatistics.h"

#include <rosbag/message_instance.h>
#include <viwo/core/Error.h>

#include <algorithm>
#include <map>
#include <set>

namespace viwo
{
namespace
{
SensorRole roleOfType(const std::string& type)
{
	if (isImageType(type)) return SensorRole::camera;
	if (isOdometryType(type)) return SensorRole::wheels;
	if (type == "sensor_msgs/Imu") return SensorRole::imu;
	if (type == "sensor_msgs/LaserScan") return SensorRole::lidar;
	return type == "sensor_msgs/NavSatFix" ? SensorRole::gps : SensorRole::other;
}
}  // namespace

RecordingInfo inspectRosBag(const std::string& path, const std::function<bool(double)>& proceed)
{
	const RosBagFile bag({path});
	std::set<std::string> topics;
	size_t total = 0, done = 0;
	RecordingInfo info{path, "ROS 1 bag", {}, {}};
	const RosTopicMap map = proposeTopicMap(bag.topics());
	for (const RosTopic& topic : bag.topics())
	{
		if (!isConvertible(topic.type))
		{
			info.notes.push_back(topic.name + ": " + std::to_string(topic.messages) + " " + topic.type);
			continue;
		}
		topics.insert(topic.name);
		total += topic.messages;
	}
	StreamStatistics statistics;
	bag.visit(topics,
	          [&](const rosbag::MessageInstance& message)
	          {
		          const std::string& name = message.getTopic();
		          StreamInfo& stream =
		              statistics.add(name, message.getDataType(), roleOfType(message.getDataType()), stampOf(readHeader(message), false));
		          stream.calibrated = std::any_of(map.topics.begin(), map.topics.end(),
		                                          [&](const TopicMapping& m) { return m.topic == name && !m.camera_info.empty(); });
		          if (!proceed(static_cast<double>(++done) / static_cast<double>(total)))
			          throw Error("interrupted: " + path + " was not looked through");
		          return true;
	          });
	info.streams = statistics.finish();
	return info;
}
}  // namespace viwo
