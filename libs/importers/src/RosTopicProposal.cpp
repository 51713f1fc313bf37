#include "RosTopicMap.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>
#include <utility>

namespace viwo
{
namespace
{
bool holdsAny(const std::string& text, std::initializer_list<const char*> words)
{
	return std::any_of(words.begin(), words.end(), [&](const char* word) { return text.find(word) != std::string::npos; });
}

std::string lowered(std::string name)
{
	for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
	return name;
}

std::string parentOf(const std::string& topic)
{
	const size_t slash = topic.rfind('/');
	return slash == std::string::npos ? "" : topic.substr(0, slash);
}

constexpr char kCompressed[] = "/compressed";

/** Without image_transport's ending. */
std::string pictureName(const std::string& topic)
{
	const size_t length = sizeof kCompressed - 1;
	const bool ends = topic.size() > length && topic.compare(topic.size() - length, length, kCompressed) == 0;
	return ends ? topic.substr(0, topic.size() - length) : topic;
}

std::string labelFor(const std::string& type)
{
	if (isImageType(type)) return "CAM";
	if (isOdometryType(type)) return "ODOMETRY";
	if (type == "sensor_msgs/Imu") return "IMU";
	if (type == "sensor_msgs/NavSatFix") return "GPS";
	return type == "sensor_msgs/LaserScan" ? "LASER" : "POINTS";
}

/** The lower, the sooner it is what its label means: the wheels' own odometry, the IMU's calibrated output, a camera's raw pictures. */
int rank(const RosTopic& topic)
{
	const std::string name = lowered(topic.name);
	if (isOdometryType(topic.type))
	{
		if (holdsAny(name, {"truth", "filtered", "fused", "visual", "vio", "gps", "lidar", "laser", "map", "cmd"})) return 3;
		return topic.type != "nav_msgs/Odometry" ? 2 : holdsAny(name, {"wheel", "velocity_controller", "base"}) ? 0 : 1;
	}
	if (isImageType(topic.type)) return isRectified(topic.name) ? 2 : holdsAny(name, {"left", "cam0", "infra1"}) ? 0 : 1;
	return holdsAny(name, {"raw"}) ? 1 : 0;
}

/** Why a topic is not taken; empty: it is. */
std::string objection(const RosTopic& topic, const std::vector<RosTopic>& topics)
{
	if (topic.type == "sensor_msgs/JointState") return "give left_joints, right_joints, wheel_radius_m and track_m in a map to use it";
	const std::string name = lowered(topic.name);
	if (isOdometryType(topic.type) && holdsAny(name, {"truth"})) return "set ground_truth to it in a map to have its poses";
	if (topic.type == "geometry_msgs/TwistStamped" && holdsAny(name, {"cmd"})) return "a command, not a measurement";
	if (!isImageType(topic.type)) return "";
	if (isNamedAsDepth(topic.name)) return "not a picture in grey or colour";
	const auto isThere = [&](const std::string& other)
	{ return std::any_of(topics.begin(), topics.end(), [&](const RosTopic& t) { return t.name == other && isImageType(t.type); }); };
	if (topic.type == "sensor_msgs/CompressedImage" && isThere(parentOf(topic.name))) return "the same pictures as " + parentOf(topic.name);
	if (!isRectified(topic.name)) return "";
	for (const char* raw : {"/image_raw", "/image_mono"})
		for (const char* transport : {"", kCompressed})
			if (const std::string other = parentOf(pictureName(topic.name)) + raw + transport; isThere(other))
				return "the same camera as " + other;
	return "";
}

/** By ROS' convention beside the image. */
std::string cameraInfoOf(const RosTopic& image, const std::vector<RosTopic>& topics)
{
	const std::string folder = parentOf(image.name);
	for (const std::string& place : {folder, parentOf(folder)})
		for (const RosTopic& topic : topics)
			if (topic.type == "sensor_msgs/CameraInfo" && topic.name == place + "/camera_info") return topic.name;
	return "";
}
}  // namespace

bool isRectified(const std::string& topic)
{
	const std::string picture = lowered(pictureName(topic));
	std::istringstream last_word(picture.substr(picture.rfind('/') + 1));
	for (std::string part; std::getline(last_word, part, '_');)
		if (part == "rect" || part == "rectified") return true;
	return false;
}

bool isNamedAsDepth(const std::string& topic)
{
	// The picture and its folder: /depth_camera/color/image_raw is none.
	const std::string picture = lowered(pictureName(topic));
	const size_t folder = parentOf(picture).rfind('/');
	return holdsAny(folder == std::string::npos ? picture : picture.substr(folder), {"depth", "disparity", "mask"});
}

RosTopicMap proposeTopicMap(const std::vector<RosTopic>& topics, const std::map<std::string, std::string>& objections)
{
	RosTopicMap map;
	const auto leaveOut = [&map](const RosTopic& topic, const std::string& why_not)
	{ map.notes.push_back(topic.name + " (" + topic.type + ") is left out: " + why_not); };
	std::vector<RosTopic> usable, taken;
	std::string previous;
	for (const RosTopic& topic : topics)
	{
		// Of two types on one topic the first is read, see RosBagFile.
		if (std::exchange(previous, topic.name) == topic.name) continue;
		const auto known = objections.find(topic.name);
		if (known == objections.end() || known->second.empty())
			usable.push_back(topic);
		else
			leaveOut(topic, known->second);
	}
	for (const RosTopic& topic : usable)
	{
		if (!isConvertible(topic.type)) continue;
		const std::string why_not = objection(topic, usable);
		if (why_not.empty())
			taken.push_back(topic);
		else
			leaveOut(topic, why_not);
	}
	std::stable_sort(taken.begin(), taken.end(),
	                 [](const RosTopic& a, const RosTopic& b) { return rank(a) != rank(b) ? rank(a) < rank(b) : a.name < b.name; });

	std::map<std::string, int> used;
	for (const RosTopic& topic : taken)
	{
		TopicMapping mapping;
		mapping.topic = topic.name;
		mapping.label = labelFor(topic.type);
		const int number = ++used[mapping.label];
		if (number > 1) mapping.label += std::to_string(number);
		if (isImageType(topic.type)) mapping.camera_info = cameraInfoOf(topic, usable);
		map.topics.push_back(std::move(mapping));
	}
	// For the eye: one label's kind after the other.
	std::stable_sort(map.topics.begin(), map.topics.end(), [](const TopicMapping& a, const TopicMapping& b) { return a.label < b.label; });
	return map;
}
}  // namespace viwo
