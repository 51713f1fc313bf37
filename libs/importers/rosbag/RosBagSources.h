#pragma once

#include "FrameTree.h"
#include "RosBagFile.h"
#include "RosMessages.h"
#include "RosWheels.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace viwo
{
/** A topic that is imported, with what must be known before its first observation is written. */
struct RosSource
{
	TopicMapping mapping;
	std::string type;
	std::string frame;  //!< of its first message: where the sensor is; of an odometry: whose motion it tells, empty where that is not said
	bool placed = false;        //!< the pose is that of the map or of tf
	Pose3 T_OS;                 //!< pose of the sensor in O
	std::optional<Pose3> T_SO;  //!< of an odometry: O in `frame`, where that is another one to which tf leads
	CameraModel camera;         //!< of images; focal length 0 where there is no calibration, size 0 where it does not tell that
	RosWheels wheels;           //!< of a JointState
};

/** The topic that has the truth. */
struct RosTruth
{
	std::string topic;        //!< empty: none
	std::string child_frame;  //!< whose poses these are; empty: the messages do not say
	/** O in that frame; nothing where no chain of transforms leads there. */
	std::optional<Pose3> T_SO;
};

/** Looks through the bag for all of that: headers, tf, camera infos, and the axes of an IMU that nobody places. */
class RosBagSources
{
   public:
	/** @throws Error: a topic without messages, a lens that is not supported, a base frame or a joint that is not there. */
	RosBagSources(const RosBagFile& bag, const RosTopicMap& map, bool record_time);

	std::vector<RosSource>& sources() { return sources_; }
	const FrameTree& frames() const { return frames_; }
	/** Of a message of movingTransforms(): how far frames move, and which transforms are none. */
	void takeTransforms(const rosbag::MessageInstance& message) { readTransforms(message, true); }
	const RosTruth& truth() const { return truth_; }
	const std::string& baseFrame() const { return base_frame_; }
	/** All that are read: those of the map, and of tf. */
	std::set<std::string> topics() const;
	/** Topics of tf that tell of moving frames. */
	const std::vector<std::string>& movingTransforms() const { return tf_; }
	const std::vector<std::string>& notes() const { return notes_; }
	/** One line for each pair of frames with transforms that are none. */
	std::vector<std::string> notesOnTransforms() const;

   private:
	RosHeader firstHeader(const std::string& topic);
	void readHeaders(const RosTopicMap& map);
	void findTransformTopics();
	void readTransforms(const rosbag::MessageInstance& message, bool count);
	void readFrames();
	/** Of an odometry whose frame static transforms do not lead to: only all of tf tells whether that is fixed on the vehicle. */
	bool needsAllTransforms() const;
	void chooseBaseFrame(const std::string& wanted);
	/** The header of a TwistStamped does not tell the vehicle's frame for sure: the last choice. */
	void takeFrameOfTwist();
	bool isKnown(const std::string& frame) const;
	void requireBaseFrame() const;
	bool allPlaced() const;
	void placeTruth();
	std::string whyNotPlaced(const RosSource& source) const;
	void place(RosSource& source);
	void placeOdometry(RosSource& source);
	void readCamera(RosSource& source);
	void placeByGravity(RosSource& source, bool record_time);

	const RosBagFile& bag_;
	std::vector<RosSource> sources_;
	FrameTree frames_;
	RosTruth truth_;
	std::set<std::string> frames_of_headers_;
	std::map<std::pair<std::string, std::string>, size_t> broken_;  //!< transforms that are none: how many from a parent to a child
	std::vector<std::string> tf_static_, tf_;                       //!< topics, the first ones' transforms count
	std::string base_frame_;
	std::vector<std::string> notes_;
};
}  // namespace viwo
