#pragma once

#include <viwo/core/Options.h>
#include <viwo/core/Pose3.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** A topic of a bag. */
struct RosTopic
{
	std::string name, type;  //!< "/imu/data", "sensor_msgs/Imu"
	size_t messages = 0;
};

/** What one topic becomes: a section of the map, whose name is the label. */
struct TopicMapping : Options<TopicMapping>
{
	std::string label;
	std::string topic;
	std::string camera_info;
	std::vector<double> position_m, yaw_pitch_roll_deg;
	std::string left_joints, right_joints;
	double wheel_radius_m = 0, track_m = 0;

	/** T_O_sensor where the map gives one. */
	std::optional<Pose3> sensorPose() const;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("topic", topic, "of the bag");
		v("camera_info", camera_info, "images: topic of the lens calibration");
		v("position_m", position_m, "of the sensor in O, x y z; empty: tf");
		v("yaw_pitch_roll_deg", yaw_pitch_roll_deg, "of the sensor in O (of images: of the optical axes); empty: tf");
		v("left_joints", left_joints, "JointState: names of the left wheels' joints");
		v("right_joints", right_joints, "JointState: names of the right wheels' joints");
		v("wheel_radius_m", wheel_radius_m, "JointState", 0.0, 100.0);
		v("track_m", track_m, "JointState: distance between left and right wheels", 0.0, 100.0);
	}
};

/** Which topics become what. */
struct RosTopicMap
{
	struct General : Options<General>
	{
		std::string base_frame;
		std::string ground_truth;

		template <class Visitor>
		void visit(Visitor& v)
		{
			v("base_frame", base_frame, "the frame that is O; empty: the odometry's child frame");
			v("ground_truth", ground_truth, "topic (Odometry or PoseStamped) whose poses are the truth; empty: none");
		}
	};
	General general;
	std::vector<TopicMapping> topics;
	std::vector<std::string> notes;  //!< of the proposal: what was left out, and why
};

/** "/imu/data (sensor_msgs/Imu), ..." or "none". */
std::string namesOfTopics(const std::vector<RosTopic>& topics);

/** True for the message types that become observations. */
bool isConvertible(const std::string& type);
bool isImageType(const std::string& type);
/** Of the vehicle's motion, as twists or as joints of its wheels. */
bool isOdometryType(const std::string& type);
/** Of these those that tell of which frame their twists are. */
bool isTwistType(const std::string& type);
/** Two names of one definition. */
bool isTransformType(const std::string& type);
/** The first of a name, which of a topic of two types is the one that is read; null: there is none. */
const RosTopic* findTopic(const std::vector<RosTopic>& topics, const std::string& name);
/** The names in left_joints or right_joints, which blanks separate. */
std::vector<std::string> jointsOf(const std::string& names);

/** True for pictures from which the lens' distortion was taken: a part of the last word is rect, as in /left/image_rect_color. */
bool isRectified(const std::string& topic);
/** True for pictures that are no grey or colour by their topic's name: depth, disparity, masks. */
bool isNamedAsDepth(const std::string& topic);

/** The map as a file has it: [general] and a section per label. @throws Error naming file, section and key. */
RosTopicMap readTopicMap(const std::string& ini_path, const std::vector<RosTopic>& topics);

/** Every convertible topic under a label that viwo's programs expect: IMU, ODOMETRY, CAM, CAM2, LASER, GPS, POINTS. Of several odometries
 * the one with a wheel's name first; pictures of depth are left out.
 *  @param objections by topic, why one cannot be taken, or empty. */
RosTopicMap proposeTopicMap(const std::vector<RosTopic>& topics, const std::map<std::string, std::string>& objections = {});

/** The map as text that readTopicMap() reads. */
std::string describeTopicMap(const RosTopicMap& map);
}  // namespace viwo
