#include "RosTopicMap.h"

#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <viwo/core/Error.h>
#include <viwo/core/MountingPose.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>

namespace viwo
{
namespace
{
constexpr char kGeneral[] = "general";

const RosTopic& requireTopic(const std::vector<RosTopic>& topics, const std::string& name, const std::string& where)
{
	const RosTopic* topic = findTopic(topics, name);
	if (topic == nullptr) throw Error(where + " = " + name + ": not a topic of the bag, which has: " + namesOfTopics(topics));
	return *topic;
}

void checkPose(const TopicMapping& mapping, const std::string& where)
{
	const auto isTriple = [](const std::vector<double>& v) { return v.empty() || v.size() == 3; };
	if (!isTriple(mapping.position_m)) throw Error(where + "position_m: expected three numbers, x y z");
	if (!isTriple(mapping.yaw_pitch_roll_deg)) throw Error(where + "yaw_pitch_roll_deg: expected three numbers");
	if (mapping.position_m.empty() != mapping.yaw_pitch_roll_deg.empty())
		throw Error(where + "give both position_m and yaw_pitch_roll_deg, or none of them");
}

/** What would not count is refused, as it was meant to. */
void checkUse(const TopicMapping& mapping, const std::string& type, const std::string& where)
{
	const bool is_joints = type == "sensor_msgs/JointState";
	const bool has_joints =
	    !mapping.left_joints.empty() || !mapping.right_joints.empty() || mapping.wheel_radius_m != 0 || mapping.track_m != 0;
	if (has_joints && !is_joints)
		throw Error(where + "left_joints, right_joints, wheel_radius_m and track_m are of a JointState, and " + mapping.topic + " is a " +
		            type + "; leave them out");
	if (!mapping.camera_info.empty() && !isImageType(type))
		throw Error(where + "camera_info is of pictures, and " + mapping.topic + " is a " + type + "; leave it out");
	if (!mapping.position_m.empty() && isOdometryType(type))
		throw Error(where + "position_m and yaw_pitch_roll_deg are of a sensor, and " + mapping.topic + " has the motion of O itself (" +
		            type + "); leave them out");
}

void checkJoints(const TopicMapping& mapping, const std::string& where)
{
	if (mapping.left_joints.empty() || mapping.right_joints.empty() || mapping.wheel_radius_m <= 0 || mapping.track_m <= 0)
		throw Error(where + "JointState needs left_joints, right_joints, wheel_radius_m and track_m");
	const std::vector<std::string> right = jointsOf(mapping.right_joints);
	for (const std::string& joint : jointsOf(mapping.left_joints))
		if (std::find(right.begin(), right.end(), joint) != right.end())
			throw Error(where + "left_joints and right_joints both name " + joint + "; name each joint on its own side");
}

void checkMapping(const TopicMapping& mapping, const std::vector<RosTopic>& topics, const std::string& where)
{
	// Labels are in the names of the picture files.
	if (mapping.label.find_first_of("/\\") != std::string::npos)
		throw Error(where + "a label becomes part of file names and cannot have / or \\; name it otherwise");
	if (mapping.topic.empty()) throw Error(where + "topic: is missing");
	const RosTopic& topic = requireTopic(topics, mapping.topic, where + "topic");
	if (!isConvertible(topic.type)) throw Error(where + "topic = " + topic.name + ": " + topic.type + " cannot become an observation");
	checkPose(mapping, where);
	if (!mapping.camera_info.empty())
	{
		const RosTopic& info = requireTopic(topics, mapping.camera_info, where + "camera_info");
		if (info.type != "sensor_msgs/CameraInfo") throw Error(where + "camera_info = " + info.name + ": is a " + info.type);
	}
	checkUse(mapping, topic.type, where);
	if (topic.type == "sensor_msgs/JointState") checkJoints(mapping, where);
}
}  // namespace

std::string namesOfTopics(const std::vector<RosTopic>& topics)
{
	std::string names;
	for (const RosTopic& topic : topics) names += (names.empty() ? "" : ", ") + topic.name + " (" + topic.type + ")";
	return names.empty() ? "none" : names;
}

std::optional<Pose3> TopicMapping::sensorPose() const
{
	if (position_m.empty()) return std::nullopt;
	const std::vector<double>&p = position_m, &a = yaw_pitch_roll_deg;
	return mountingPose({p[0], p[1], p[2]}, {a[0], a[1], a[2]});
}

bool isImageType(const std::string& type)
{
	return type == "sensor_msgs/Image" || type == "sensor_msgs/CompressedImage";
}

bool isOdometryType(const std::string& type)
{
	return isTwistType(type) || type == "sensor_msgs/JointState";
}

bool isTwistType(const std::string& type)
{
	return type == "nav_msgs/Odometry" || type == "geometry_msgs/TwistStamped";
}

bool isTransformType(const std::string& type)
{
	return type == "tf2_msgs/TFMessage" || type == "tf/tfMessage";
}

const RosTopic* findTopic(const std::vector<RosTopic>& topics, const std::string& name)
{
	const auto at = std::find_if(topics.begin(), topics.end(), [&](const RosTopic& t) { return t.name == name; });
	return at == topics.end() ? nullptr : &*at;
}

std::vector<std::string> jointsOf(const std::string& names)
{
	std::istringstream words(names);
	return {std::istream_iterator<std::string>(words), {}};
}

bool isConvertible(const std::string& type)
{
	return isImageType(type) || isOdometryType(type) || type == "sensor_msgs/Imu" || type == "sensor_msgs/NavSatFix" ||
	       type == "sensor_msgs/LaserScan" || type == "sensor_msgs/PointCloud2";
}

RosTopicMap readTopicMap(const std::string& ini_path, const std::vector<RosTopic>& topics)
{
	std::error_code ignored;
	if (!std::filesystem::is_regular_file(ini_path, ignored)) throw Error(ini_path + ": cannot be read; check the name");
	std::vector<std::string> sections;
	mrpt::config::CConfigFile(ini_path).getAllSections(sections);

	RosTopicMap map;
	for (const std::string& section : sections)
		if (section != kGeneral) map.topics.emplace_back().label = section;
	std::vector<OptionsSection> targets{{kGeneral, &map.general}};
	for (TopicMapping& mapping : map.topics) targets.push_back({mapping.label, &mapping});
	loadOptions(ini_path, targets);

	if (map.topics.empty()) throw Error(ini_path + ": no section; each label of the rawlog is one, [IMU] for example, with its topic");
	for (const TopicMapping& mapping : map.topics) checkMapping(mapping, topics, ini_path + ": [" + mapping.label + "] ");
	if (!map.general.ground_truth.empty())
	{
		const std::string where = ini_path + ": [general] ground_truth";
		const RosTopic& truth = requireTopic(topics, map.general.ground_truth, where);
		if (truth.type != "nav_msgs/Odometry" && truth.type != "geometry_msgs/PoseStamped")
			throw Error(where + " = " + truth.name + ": expected an Odometry or PoseStamped, not a " + truth.type);
	}
	return map;
}

std::string describeTopicMap(const RosTopicMap& map)
{
	std::ostringstream text;
	text << "[general]\n";
	if (!map.general.base_frame.empty()) text << "base_frame = " << map.general.base_frame << "\n";
	if (!map.general.ground_truth.empty()) text << "ground_truth = " << map.general.ground_truth << "\n";
	const auto triple = [&text](const char* key, const std::vector<double>& values)
	{
		if (!values.empty()) text << key << " = " << values[0] << " " << values[1] << " " << values[2] << "\n";
	};
	for (const TopicMapping& mapping : map.topics)
	{
		text << "\n[" << mapping.label << "]\ntopic = " << mapping.topic << "\n";
		if (!mapping.camera_info.empty()) text << "camera_info = " << mapping.camera_info << "\n";
		triple("position_m", mapping.position_m);
		triple("yaw_pitch_roll_deg", mapping.yaw_pitch_roll_deg);
		if (mapping.left_joints.empty()) continue;
		text << "left_joints = " << mapping.left_joints << "\nright_joints = " << mapping.right_joints
		     << "\nwheel_radius_m = " << mapping.wheel_radius_m << "\ntrack_m = " << mapping.track_m << "\n";
	}
	return text.str();
}
}  // namespace viwo
