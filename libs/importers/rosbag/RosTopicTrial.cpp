#include "RosTopicTrial.h"

#include "RosInstance.h"
#include "RosMessages.h"

namespace viwo
{
namespace
{
/** All that converting needs of a message, thrown away. @throws UnusableTopic. */
void convertOnTrial(const rosbag::MessageInstance& message)
{
	const std::string& type = message.getDataType();
	if (isImageType(type))
		RosPictures::sizeOf(message);
	else if (type == "sensor_msgs/CameraInfo")
		readCameraInfo(message, isRectified(message.getTopic()));
	else if (type == "sensor_msgs/Imu")
		readImu(message, 0);
	else if (type == "sensor_msgs/NavSatFix")
		readFix(message);
	else if (type == "sensor_msgs/LaserScan")
		scanObservation(message, 0, {}, "");
	else if (type == "sensor_msgs/PointCloud2")
		cloudObservation(message, 0, {}, "");
	else
		readTwist(message, {});
}

/** Why the first message of a topic cannot be converted; empty: it can. */
std::string objectionTo(const RosBagFile& bag, const std::string& topic)
try
{
	std::string why_not = "it has no message";
	bag.visit({topic},
	          [&](const rosbag::MessageInstance& message)
	          {
		          why_not.clear();
		          convertOnTrial(message);
		          return false;
	          });
	return why_not;
}
catch (const UnusableTopic& e)
{
	return e.why();
}
/** A driver may scale its pictures and go on to send the calibration of the large ones. */
void leaveOutForeignCameraInfo(const RosBagFile& bag, TopicMapping& mapping, std::vector<std::string>& notes)
{
	if (mapping.camera_info.empty()) return;
	std::pair<int, int> size;
	std::optional<CameraModel> camera;
	const auto first = [&bag](const std::string& topic, const auto& read)
	{ bag.visit({topic}, [&read](const rosbag::MessageInstance& message) { return read(message), false; }); };
	first(mapping.topic, [&](const rosbag::MessageInstance& message) { size = RosPictures::sizeOf(message); });
	first(mapping.camera_info,
	      [&](const rosbag::MessageInstance& message) { camera = readCameraInfo(message, isRectified(mapping.topic)); });
	if (!camera || camera->width_px() == 0 || camera->height_px() == 0 || size.first == 0) return;
	if (std::pair(camera->width_px(), camera->height_px()) == size) return;
	notes.push_back(mapping.camera_info + " is left out for " + mapping.topic + ": it is for " + std::to_string(camera->width_px()) + "x" +
	                std::to_string(camera->height_px()) + " pixels, not for " + std::to_string(size.first) + "x" +
	                std::to_string(size.second));
	mapping.camera_info.clear();
}
}  // namespace

RosTopicMap proposeTopicMap(const RosBagFile& bag)
{
	std::map<std::string, std::string> objections;
	// Where one is left out another may come in: raw pictures of an unknown encoding, rectified ones beside them.
	while (true)
	{
		RosTopicMap map = proposeTopicMap(bag.topics(), objections);
		bool settled = true;
		for (const TopicMapping& mapping : map.topics)
			for (const std::string& topic : {mapping.topic, mapping.camera_info})
			{
				if (topic.empty() || objections.count(topic) > 0) continue;
				const std::string why_not = objectionTo(bag, topic);
				objections[topic] = why_not;
				settled = settled && why_not.empty();
			}
		if (!settled) continue;
		for (TopicMapping& mapping : map.topics) leaveOutForeignCameraInfo(bag, mapping, map.notes);
		return map;
	}
}
}  // namespace viwo
