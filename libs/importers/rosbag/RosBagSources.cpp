#include "RosBagSources.h"

#include "RosInstance.h"

#include <mrpt/core/format.h>
#include <viwo/core/Joined.h>
#include <viwo/core/NumberText.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>

namespace viwo
{
namespace
{
/** Of the drive that decides on an IMU's axes. */
constexpr double kLongestLook_s = 600;
/** Frames that tf moves against each other by more are not on one rigid body. */
constexpr double kRigid_m = 0.01, kRigid_rad = 0.01;

/** Adding 0 takes the sign from -0. */
std::vector<double> yawPitchRoll_deg(const Eigen::Quaterniond& R_OS)
{
	const Eigen::Matrix3d R = R_OS.toRotationMatrix();
	const double pitch_rad = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))), roll_rad = std::atan2(R(2, 1), R(2, 2));
	const auto rounded_deg = [](double angle_rad) { return std::round(angle_rad / kDegree * 1e6) * 1e-6 + 0; };
	return {rounded_deg(yawOf(R_OS)), rounded_deg(pitch_rad), rounded_deg(roll_rad)};
}

std::string poseText(const Pose3& T)
{
	const std::vector<double> angles_deg = yawPitchRoll_deg(T.R);
	return mrpt::format("position_m = %.4g %.4g %.4g, yaw_pitch_roll_deg = %.4g %.4g %.4g", T.p.x() + 0, T.p.y() + 0, T.p.z() + 0,
	                    angles_deg[0], angles_deg[1], angles_deg[2]);
}

/** "/robot1/" of "/robot1/tf"; of "/tf" and "tf" none. */
std::string namespaceOf(const std::string& topic)
{
	const std::string space = topic.substr(0, topic.rfind('/') + 1);
	return space == "/" ? "" : space;
}

std::string lastNameOf(const std::string& topic)
{
	return topic.substr(topic.rfind('/') + 1);
}
/** Of REP 105: no frame of a vehicle, though drivers write them into the headers of its twists. */
bool isWorldFrame(const std::string& frame)
{
	return frame == "odom" || frame == "map" || frame == "earth" || frame == "world";
}
}  // namespace

RosBagSources::RosBagSources(const RosBagFile& bag, const RosTopicMap& map, bool record_time) : bag_(bag)
{
	readHeaders(map);
	chooseBaseFrame(map.general.base_frame);
	findTransformTopics();
	readFrames();
	chooseBaseFrame(map.general.base_frame);
	if (base_frame_.empty()) takeFrameOfTwist();
	requireBaseFrame();
	placeTruth();
	for (RosSource& source : sources_)
	{
		if (isImageType(source.type)) readCamera(source);
		if (isTwistType(source.type))
			placeOdometry(source);
		else if (source.type == "sensor_msgs/JointState")
			source.wheels = RosWheels(bag, source.mapping, record_time);
		else
			place(source);
	}
	for (RosSource& source : sources_)
		if (!source.placed && source.type == "sensor_msgs/Imu") placeByGravity(source, record_time);
}

RosHeader RosBagSources::firstHeader(const std::string& topic)
{
	std::optional<RosHeader> first;
	bag_.visitFirst(topic, [&](const rosbag::MessageInstance& message) { first = readHeader(message); });
	if (!first) throw Error(bag_.name() + ": " + topic + " has no message; leave it out by a --map");
	for (const std::string& frame : {first->frame, first->child_frame})
		if (!frame.empty()) frames_of_headers_.insert(FrameTree::plainName(frame));
	return *first;
}

void RosBagSources::readHeaders(const RosTopicMap& map)
{
	truth_.topic = map.general.ground_truth;
	if (!truth_.topic.empty()) truth_.child_frame = FrameTree::plainName(firstHeader(truth_.topic).child_frame);
	for (const TopicMapping& mapping : map.topics)
	{
		RosSource source;
		source.mapping = mapping;
		if (const RosTopic* topic = findTopic(bag_.topics(), mapping.topic)) source.type = topic->type;
		const RosHeader header = firstHeader(mapping.topic);
		source.frame = source.type == "nav_msgs/Odometry" ? header.child_frame : header.frame;
		if (isOdometryType(source.type)) source.frame = FrameTree::plainName(source.frame);
		sources_.push_back(std::move(source));
	}
}

bool RosBagSources::isKnown(const std::string& frame) const
{
	return frames_.has(frame) || frames_of_headers_.count(frame) > 0;
}

void RosBagSources::requireBaseFrame() const
{
	if (base_frame_.empty() || isKnown(base_frame_)) return;
	std::set<std::string> known = frames_.names();
	known.insert(frames_of_headers_.begin(), frames_of_headers_.end());
	throw Error(bag_.name() + ": [general] base_frame = " + base_frame_ +
	            ": neither tf nor a message names this frame; there are: " + (known.empty() ? "none" : joined(known)));
}

bool RosBagSources::allPlaced() const
{
	if (!base_frame_.empty() && !isKnown(base_frame_)) return false;
	if (!truth_.child_frame.empty() && !base_frame_.empty() && !frames_.find(truth_.child_frame, base_frame_)) return false;
	return std::all_of(sources_.begin(), sources_.end(),
	                   [this](const RosSource& source)
	                   {
		                   if (source.type == "sensor_msgs/JointState" || source.mapping.sensorPose()) return true;
		                   if (isTwistType(source.type) && (source.frame.empty() || source.frame == base_frame_)) return true;
		                   return !base_frame_.empty() && frames_.find(base_frame_, source.frame).has_value();
	                   });
}

bool RosBagSources::needsAllTransforms() const
{
	return std::any_of(sources_.begin(), sources_.end(),
	                   [this](const RosSource& source) {
		                   return isTwistType(source.type) && !source.frame.empty() && source.frame != base_frame_ &&
		                          !frames_.find(base_frame_, source.frame);
	                   });
}

void RosBagSources::readTransforms(const rosbag::MessageInstance& message, bool count)
{
	viwo::readTransforms(message,
	                     [&](const std::string& parent, const std::string& child, const std::optional<Pose3>& T)
	                     {
		                     if (T)
			                     frames_.add(parent, child, *T);
		                     else
			                     broken_[{FrameTree::plainName(parent), FrameTree::plainName(child)}] += count ? 1 : 0;
	                     });
}

std::vector<std::string> RosBagSources::notesOnTransforms() const
{
	std::vector<std::string> notes;
	for (const auto& [frames, count] : broken_)
		notes.push_back("tf: left out: " + counted(count, "transform") + " from '" + frames.first + "' to '" + frames.second +
		                "', with a value that is not finite or a quaternion whose length is not 1");
	return notes;
}

void RosBagSources::readFrames()
{
	for (const std::string& topic : tf_static_)
		bag_.visit({topic},
		           [&](const rosbag::MessageInstance& message)
		           {
			           readTransforms(message, true);
			           return true;
		           });
	const bool all = needsAllTransforms();
	// Large where a robot has many joints: no further than needed. What is none is counted when the bag is imported.
	for (const std::string& topic : tf_)
		bag_.visit({topic},
		           [&](const rosbag::MessageInstance& message)
		           {
			           if (!all && allPlaced()) return false;
			           readTransforms(message, false);
			           return true;
		           });
}

void RosBagSources::findTransformTopics()
{
	const auto strangeness = [this](const std::string& topic)
	{
		const std::string space = namespaceOf(topic);
		const auto isInside = [&](const RosSource& source) { return source.mapping.topic.compare(0, space.size(), space) == 0; };
		return space.empty() ? 0 : std::any_of(sources_.begin(), sources_.end(), isInside) ? 1 : 2;
	};
	std::set<std::string> elsewhere;
	for (auto& [ending, found] : {std::pair("tf_static", &tf_static_), std::pair("tf", &tf_)})
	{
		for (const RosTopic& topic : bag_.topics())
			if (isTransformType(topic.type) && lastNameOf(topic.name) == ending) found->push_back(topic.name);
		std::stable_sort(found->begin(), found->end(),
		                 [&](const std::string& a, const std::string& b) { return strangeness(a) < strangeness(b); });
		for (const std::string& topic : *found)
			if (!namespaceOf(topic).empty()) elsewhere.insert(topic);
	}
	if (!elsewhere.empty())
		notes_.push_back("tf is taken from " + joined(elsewhere) + ", too; frames of one name are one frame, whose first transform counts");
}

std::set<std::string> RosBagSources::topics() const
{
	std::set<std::string> topics{truth_.topic};
	for (const RosSource& source : sources_) topics.insert({source.mapping.topic, source.mapping.camera_info});
	topics.insert(tf_.begin(), tf_.end());
	topics.insert(tf_static_.begin(), tf_static_.end());
	return topics;
}

void RosBagSources::chooseBaseFrame(const std::string& wanted)
{
	base_frame_ = FrameTree::plainName(wanted);
	for (const bool of_label : {true, false})
		for (const RosSource& source : sources_)
			if (base_frame_.empty() && source.type == "nav_msgs/Odometry" && (!of_label || source.mapping.label == "ODOMETRY"))
				base_frame_ = source.frame;
	for (const char* usual : {"base_link", "base_footprint"})
		if (base_frame_.empty() && frames_.has(usual)) base_frame_ = usual;
}

void RosBagSources::takeFrameOfTwist()
{
	for (const RosSource& source : sources_)
		if (base_frame_.empty() && source.type == "geometry_msgs/TwistStamped" && !isWorldFrame(source.frame)) base_frame_ = source.frame;
}

void RosBagSources::placeTruth()
{
	if (truth_.topic.empty()) return;
	if (!truth_.child_frame.empty() && !base_frame_.empty()) truth_.T_SO = frames_.find(truth_.child_frame, base_frame_);
	if (truth_.T_SO) return;
	const std::string why = truth_.child_frame.empty()
	                            ? "its messages do not say of which frame their poses are"
	                            : "tf has no way from its frame '" + truth_.child_frame + "' to '" + base_frame_ + "'";
	notes_.push_back(truth_.topic + ": " + why +
	                 "; the ground truth takes them for poses of O: what lies between the two will look like an error of an estimate");
}

std::string RosBagSources::whyNotPlaced(const RosSource& source) const
{
	if (base_frame_.empty()) return "the vehicle's frame is not known (no base_frame)";
	if (source.frame.empty()) return "its messages name no frame";
	const std::string frame = FrameTree::plainName(source.frame);
	const bool is_broken = std::any_of(broken_.begin(), broken_.end(), [&](const auto& b) { return b.first.second == frame; });
	return "tf has no " + std::string(is_broken && !frames_.has(frame) ? "transform that is one to" : "frame") + " '" + source.frame +
	       "' under '" + base_frame_ + "'";
}

void RosBagSources::place(RosSource& source)
{
	const std::string& label = source.mapping.label;
	if (const auto T_OS = source.mapping.sensorPose())
	{
		source.T_OS = *T_OS, source.placed = true;
		return;
	}
	const auto T_OS = base_frame_.empty() ? std::nullopt : frames_.find(base_frame_, source.frame);
	if (T_OS)
	{
		source.T_OS = *T_OS, source.placed = true;
		notes_.push_back(label + ": by tf from " + base_frame_ + " to " + source.frame + ", " + poseText(*T_OS));
		return;
	}
	if (isImageType(source.type)) source.T_OS.R = forwardOpticalAxes();
	if (source.type == "sensor_msgs/Imu") return;  // gravity will tell
	notes_.push_back(label + ": " + whyNotPlaced(source) + "; assumed " +
	                 (isImageType(source.type) ? "in O, looking forward" : "in O, with O's axes") +
	                 ": give position_m and yaw_pitch_roll_deg in a --map");
}

void RosBagSources::placeOdometry(RosSource& source)
{
	if (source.frame.empty() || base_frame_.empty() || source.frame == base_frame_) return;
	const std::string& label = source.mapping.label;
	const char* what = source.type == "nav_msgs/Odometry" ? "twists and poses" : "twists";
	const FrameTree::Motion motion = frames_.motionBetween(base_frame_, source.frame);
	if (motion.translation_m > kRigid_m || motion.rotation_rad > kRigid_rad)
	{
		notes_.push_back(label + ": its " + what + " are those of '" + source.frame + "'" +
		                 mrpt::format(", which tf moves against '%s', by %.3f m and %.2f deg, as a frame that is not fixed on the vehicle",
		                              base_frame_.c_str(), motion.translation_m, motion.rotation_rad / kDegree) +
		                 "; not moved by tf, taken for those of O as they are");
		return;
	}
	source.T_SO = frames_.find(source.frame, base_frame_);
	source.placed = source.T_SO.has_value();
	notes_.push_back(label + ": its " + what + " are those of '" + source.frame + "', " +
	                 (source.placed ? "moved to '" + base_frame_ + "' by tf, where it is at " + poseText(source.T_SO->inverse())
	                                : "and tf has no way from there to '" + base_frame_ + "'; taken for those of O" +
	                                      (isWorldFrame(source.frame) ? "" : ": set base_frame = " + source.frame + " where they differ")));
}

void RosBagSources::readCamera(RosSource& source)
{
	const std::string& label = source.mapping.label;
	if (source.mapping.camera_info.empty())
	{
		notes_.push_back(label + ": no CameraInfo; put the calibration in with `rawlog-edit --camera-params` before it is used");
		return;
	}
	const bool rectified = isRectified(source.mapping.topic);
	bool calibrated = false;
	bag_.visit({source.mapping.camera_info},
	           [&](const rosbag::MessageInstance& message)
	           {
		           const auto camera = readCameraInfo(message, rectified);
		           if (camera) source.camera = *camera, calibrated = true;
		           return !calibrated;
	           });
	if (calibrated && (source.camera.width_px() == 0 || source.camera.height_px() == 0))
		notes_.push_back(label + ": " + source.mapping.camera_info +
		                 " has a calibration for pictures of size 0; that of the pictures was taken");
	if (!calibrated)
		notes_.push_back(label + ": " + source.mapping.camera_info +
		                 " says that the camera is not calibrated (K is 0); put the calibration in with `rawlog-edit --camera-params`");
}

void RosBagSources::placeByGravity(RosSource& source, bool record_time)
{
	const auto odometry_source = std::find_if(sources_.begin(), sources_.end(), [](const RosSource& s) { return isTwistType(s.type); });
	std::vector<ImuSample> imu;
	std::vector<StampedTwist> odometry;
	std::set<std::string> topics{source.mapping.topic};
	std::optional<int64_t> begin_ns;
	if (odometry_source != sources_.end())
		topics.insert(odometry_source->mapping.topic);
	else if (const auto joints =
	             std::find_if(sources_.begin(), sources_.end(), [](const RosSource& s) { return s.type == "sensor_msgs/JointState"; });
	         joints != sources_.end())
		odometry = joints->wheels.samples();
	bag_.visit(topics,
	           [&](const rosbag::MessageInstance& message)
	           {
		           const RosHeader header = readHeader(message);
		           const int64_t t_ns = stampOf(header, record_time);
		           if (message.getTopic() == source.mapping.topic)
			           imu.push_back(readImu(message, t_ns));
		           else
		           {
			           const mrpt::math::TTwist2D twist = readTwist(message, odometry_source->T_SO);
			           odometry.push_back({t_ns, {twist.vx, twist.omega}});
		           }
		           // By the recorder's clock: those of the sensors may be apart.
		           if (!begin_ns && !imu.empty()) begin_ns = header.record_ns;
		           return !begin_ns || secondsBetween(*begin_ns, header.record_ns) < kLongestLook_s;
	           });
	const auto axes = guessImuAxes(imu, odometry);
	if (!axes)
	{
		notes_.push_back(source.mapping.label + ": fewer than ten samples to tell its axes; assumed those of O");
		return;
	}
	source.T_OS.R = axes->R_OB;
	source.mapping.position_m = {0, 0, 0};
	source.mapping.yaw_pitch_roll_deg = yawPitchRoll_deg(source.T_OS.R);
	const Eigen::Vector3d& force_B = axes->mean_force_B_m_s2;
	std::string note = source.mapping.label + ": " + whyNotPlaced(source);
	note += mrpt::format("; by its mean specific force (%.2f, %.2f, %.2f) m/s^2, %.1f deg from an axis; ", force_B.x(), force_B.y(),
	                     force_B.z(), axes->tilt_rad / kDegree);
	note += axes->forward_correlation
	            ? mrpt::format("forward by the odometry's accelerations (correlation %.2f)", *axes->forward_correlation)
	            : std::string("forward is a guess (") +
	                  (odometry.empty() ? "no odometry" : "the odometry hardly accelerates, or otherwise than any of the four headings") +
	                  ")";
	if (axes->yaw_rate_correlation) note += mrpt::format(", yaw rates agree by %.2f", *axes->yaw_rate_correlation);
	notes_.push_back(note + ": " + poseText(source.T_OS) + "; its place is unknown, give it in a --map");
}
}  // namespace viwo
