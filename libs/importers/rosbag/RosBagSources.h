#pragma once

#include "FrameTree.h"
#include "RosBagFile.h"
#include "RosMessages.h"

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
	std::string frame;  //!< of its first message
	std::string child_frame;
	bool placed = false;  //!< the pose is that of the map or of tf
	Pose3 T_OS;           //!< pose of the sensor in O
	CameraModel camera;   //!< of images; focal length 0 where there is no calibration
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
	const std::vector<std::string>& notes() const { return notes_; }

   private:
	RosHeader firstHeader(const std::string& topic);
	void readHeaders(const RosTopicMap& map);
	void readFrames();
	void chooseBaseFrame(const std::string& wanted);
	bool isKnown(const std::string& frame) const;
	void requireBaseFrame() const;
	bool allPlaced() const;
	void placeTruth();
	std::string whyNotPlaced(const RosSource& source) const;
	void place(RosSource& source);
	void readCamera(RosSource& source);
	void placeByGravity(RosSource& source, bool record_time);

	const RosBagFile& bag_;
	std::vector<RosSource> sources_;
	FrameTree frames_;
	RosTruth truth_;
	std::set<std::string> frames_of_headers_;
	std::string base_frame_;
	std::vector<std::string> notes_;
};

/** The stamp of a message: of its header, or, on request or where that is 0, of its recording. */
inline int64_t stampOf(const RosHeader& header, bool record_time)
{
	return record_time || header.header_ns == 0 ? header.record_ns : header.header_ns;
}
}  // namespace viwo
