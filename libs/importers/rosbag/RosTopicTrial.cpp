#include "RosTopicTrial.h"

#include "RosInstance.h"
#include "RosMessages.h"

#include <algorithm>

namespace viwo
{
namespace
{
/** What the first message of a topic shows. */
struct Trial
{
	std::string why_not;  //!< empty: it can be converted
	bool is_damaged_picture = false;
};

/** 0 also where the lengths in the message are damaged. @throws UnusableTopic. */
std::pair<int, int> sizeOnTrial(const rosbag::MessageInstance& message)
try
{
	return RosPictures::sizeOf(message);
}
catch (const UnusableTopic&)
{
	throw;
}
catch (const Error&)
{
	return {0, 0};
}

/** All that converting needs of a message, thrown away. @throws UnusableTopic. */
Trial convertOnTrial(const rosbag::MessageInstance& message)
{
	const std::string& type = message.getDataType();
	if (isImageType(type))
	{
		if (sizeOnTrial(message).first == 0) return {"its first picture is damaged or of size 0", true};
	}
	else if (type == "sensor_msgs/CameraInfo")
		readCameraInfo(message, true);  // whether the lens can be had is for each of its pictures to ask
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
	return {};
}

Trial trialOf(const RosBagFile& bag, const std::string& topic)
try
{
	Trial trial{"it has no message"};
	bag.visitFirst(topic, [&](const rosbag::MessageInstance& message) { trial = convertOnTrial(message); });
	return trial;
}
catch (const UnusableTopic& e)
{
	return {e.why()};
}

/** Why a CameraInfo is none of these pictures; empty: it is, or says nothing of it. Of rectified ones the lens does not matter, and a
 *  driver may scale its pictures and go on to send the calibration of the large ones. */
std::string objectionToCameraInfo(const RosBagFile& bag, const TopicMapping& mapping)
try
{
	std::pair<int, int> size;
	std::optional<CameraModel> camera;
	bag.visitFirst(mapping.camera_info,
	               [&](const rosbag::MessageInstance& message) { camera = readCameraInfo(message, isRectified(mapping.topic)); });
	if (!camera || camera->width_px() == 0 || camera->height_px() == 0) return "";
	bag.visitFirst(mapping.topic, [&](const rosbag::MessageInstance& message) { size = sizeOnTrial(message); });
	if (size.first == 0 || std::pair(camera->width_px(), camera->height_px()) == size) return "";
	return "it is for " + std::to_string(camera->width_px()) + "x" + std::to_string(camera->height_px()) + " pixels, not for " +
	       std::to_string(size.first) + "x" + std::to_string(size.second);
}
catch (const UnusableTopic& e)
{
	return e.why();
}

void leaveOutForeignCameraInfo(const RosBagFile& bag, RosTopicMap& map)
{
	for (TopicMapping& mapping : map.topics)
	{
		if (mapping.camera_info.empty()) continue;
		const std::string why_not = objectionToCameraInfo(bag, mapping);
		if (why_not.empty()) continue;
		map.notes.push_back(mapping.camera_info + " is left out for " + mapping.topic + ": " + why_not);
		mapping.camera_info.clear();
	}
}

/** The proposal after trials of all that is in it, which `trials` keeps. */
RosTopicMap triedTopicMap(const RosBagFile& bag, std::map<std::string, Trial>& trials, bool takes_damaged_pictures)
{
	// Where one is left out another may come in: raw pictures of an unknown encoding, rectified ones beside them.
	while (true)
	{
		std::map<std::string, std::string> objections;
		for (const auto& [topic, trial] : trials)
			if (!takes_damaged_pictures || !trial.is_damaged_picture) objections[topic] = trial.why_not;
		RosTopicMap map = proposeTopicMap(bag.topics(), objections);
		bool settled = true;
		for (const TopicMapping& mapping : map.topics)
			for (const std::string& topic : {mapping.topic, mapping.camera_info})
			{
				if (topic.empty() || trials.count(topic) > 0) continue;
				trials[topic] = trialOf(bag, topic);
				settled = settled && trials[topic].why_not.empty();
			}
		if (settled) return map;
	}
}

bool hasPictures(const RosBagFile& bag, const RosTopicMap& map)
{
	const auto isPicture = [&bag](const TopicMapping& mapping) { return isImageType(findTopic(bag.topics(), mapping.topic)->type); };
	return std::any_of(map.topics.begin(), map.topics.end(), isPicture);
}
}  // namespace

RosTopicMap proposeTopicMap(const RosBagFile& bag)
{
	std::map<std::string, Trial> trials;
	RosTopicMap map = triedTopicMap(bag, trials, false);
	// A recording for which there is a camera must not become one without: then the import says what is damaged.
	if (!hasPictures(bag, map)) map = triedTopicMap(bag, trials, true);
	leaveOutForeignCameraInfo(bag, map);
	return map;
}
}  // namespace viwo
