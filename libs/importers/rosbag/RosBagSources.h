#pragma once

#include "FrameTree.h"
#include "RosBagFile.h"
#include "RosMessages.h"
#include "RosWheels.h"

#include <optional>
#include <set>
#include <string>
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
	FrameTree& frames() { return frames_; }
	const RosTruth& truth() const { return truth_; }
	const std::string& baseFrame() const { return base_frame_; }
	/** Topics of tf that tell of moving frames. */
	const std::vector<std::string>& movingTransforms() const { return tf_; }
	const std::vector<std::string>& notes() const { return notes_; }

   private:
	RosHeader firstHeader(const std::string& topic);
	void readHeaders(const RosTopicMap& map);
	void findTransformTopics();
	void readFrames();
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
	std::vector<std::string> tf_static_, tf_;  //!< topics, the first ones' transforms count
	std::string base_frame_;
	std::vector<std::string> notes_;
};
}  // namespace viwo
