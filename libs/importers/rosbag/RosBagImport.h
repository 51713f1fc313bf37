#pragma once

#include "RosBagSources.h"
#include "StampOrder.h"

#include <viwo/core/Trajectory.h>
#include <viwo/importers/ImportJob.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace viwo
{
/** One pass over a bag: every message of the map to its observation, in the order of the stamps. */
class RosBagImport
{
   public:
	RosBagImport(const RosBagFile& bag, const RosTopicMap& map, const ImportJob& job, bool record_time);

	ImportResult run();
	/** With the base frame and the poses that were found by gravity. */
	RosTopicMap usedMap();

   private:
	/** What is gathered about a topic on the way. */
	struct Tally
	{
		size_t messages = 0, without_stamp = 0, same_stamp = 0, not_finite = 0;
		size_t without_pose = 0;                                //!< of an odometry: its pose is none
		std::set<int64_t> stamps;                               //!< of the pictures, or of the wheels' samples, that were written
		Eigen::Vector3d force_sum_O = Eigen::Vector3d::Zero();  //!< of an IMU
		bool moves = false;                                     //!< of an odometry: any twist but zero
		double first_to_last_m = 0;                             //!< of an odometry: how far its own pose came
		double forward_m2_s2 = 0, sideways_m2_s2 = 0;           //!< of an odometry: sums of squared speeds
	};

	void take(const rosbag::MessageInstance& message);
	void convert(const rosbag::MessageInstance& message, const RosSource& source, int64_t t_ns);
	mrpt::obs::CObservation::Ptr odometryOf(const rosbag::MessageInstance& message, const RosSource& source, int64_t t_ns);
	mrpt::obs::CObservation::Ptr imageOf(const rosbag::MessageInstance& message, const RosSource& source, int64_t t_ns);
	void takeFix(const rosbag::MessageInstance& message, int64_t t_ns);
	void takeTruth(const rosbag::MessageInstance& message);
	void writeTracks();
	void addNotes();
	void addGpsNote();
	void addNotesOf(const RosSource& source, const Tally& tally);
	void addNotesOfOdometry(const RosSource& source, const Tally& tally);
	void addNotesOfImu(const RosSource& source, const Tally& tally);
	void note(const RosSource& source, const std::string& what);

	const RosBagFile& bag_;
	const ImportJob& job_;
	bool record_time_;
	RosTopicMap map_;
	RosBagSources found_;
	RawlogWriter writer_;
	StampOrder order_;
	RosPictures pictures_;
	std::map<std::string, Tally> tallies_;  //!< by label
	std::vector<StampedPose> truth_, gps_;
	std::string gps_label_;  //!< whose fixes are the track: of several receivers the first
	std::optional<GeodeticPoint> gps_origin_;
	ImportResult result_;
};
}  // namespace viwo
