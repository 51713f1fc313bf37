#include "RosBagSources.h"
#include "RosTopicTrial.h"
#include "StreamStatistics.h"

#include <geometry_msgs/TwistStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/message_instance.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/PointCloud2.h>
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

/** What the import proposes counts; what it leaves out is none of a mode's sensors, but joints become wheels by a map. */
StreamInfo roleIn(const RosTopicMap& map, const std::string& topic, const std::string& type)
{
	const auto at = std::find_if(map.topics.begin(), map.topics.end(), [&](const TopicMapping& m) { return m.topic == topic; });
	StreamInfo info;
	const bool needs_map = type == "sensor_msgs/JointState";
	info.role = at != map.topics.end() || needs_map ? roleOfType(type) : SensorRole::other;
	info.calibrated = at != map.topics.end() && !at->camera_info.empty();
	if (needs_map) info.remark = "needs a --map in viwo-import rosbag";
	return info;
}

template <class... Messages>
bool isAnyOf(const rosbag::MessageInstance& message)
{
	return (message.isType<Messages>() || ...);
}

/** By the header's clock; by the recorder's where another definition of the type tells nothing of where a header would be. */
int64_t stampToCount(const rosbag::MessageInstance& message)
{
	using namespace sensor_msgs;
	const bool is_known = isAnyOf<Image, CompressedImage, Imu, JointState, LaserScan, NavSatFix, PointCloud2, nav_msgs::Odometry,
	                              geometry_msgs::TwistStamped>(message);
	return is_known ? stampOf(readHeader(message), false) : static_cast<int64_t>(message.getTime().toNSec());
}
}  // namespace

RecordingInfo inspectRosBag(const std::string& path, const std::function<bool(double)>& proceed)
{
	const RosBagFile bag({path});
	size_t total = 0, done = 0;
	const RosTopicMap map = proposeTopicMap(bag);
	RecordingInfo info{path, "ROS 1 bag", {}, map.notes};
	std::map<std::string, StreamInfo> streams;
	std::set<std::string> topics;
	for (const RosTopic& topic : bag.topics())
	{
		if (topics.count(topic.name) > 0) continue;
		if (!isConvertible(topic.type))
		{
			info.notes.push_back(topic.name + ": " + std::to_string(topic.messages) + " " + topic.type);
			continue;
		}
		topics.insert(topic.name);
		streams[topic.name] = roleIn(map, topic.name, topic.type);
		total += topic.messages;
	}
	for (const std::string& note : bag.notesOnTypes(topics)) info.notes.push_back(note);
	StreamStatistics statistics;
	bag.visit(topics,
	          [&](const rosbag::MessageInstance& message)
	          {
		          const StreamInfo& known = streams[message.getTopic()];
		          StreamInfo& stream = statistics.add(message.getTopic(), message.getDataType(), known.role, stampToCount(message));
		          stream.calibrated = known.calibrated, stream.remark = known.remark;
		          if (!proceed(static_cast<double>(++done) / static_cast<double>(total)))
			          throw Error("interrupted: " + path + " was not looked through");
		          return true;
	          });
	info.streams = statistics.finish();
	return info;
}
}  // namespace viwo
