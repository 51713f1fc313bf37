#include "RosBagImport.h"

#include "OutputNames.h"
#include "RosInstance.h"

#include <mrpt/core/format.h>
#include <viwo/core/NumberText.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
/** Observations are sorted within this; a sensor whose data come later than that has another clock. */
constexpr double kReorder_s = 10;
/** Speeds sideways below this, and below this share of those forward, are noise. */
constexpr double kNoSideways_m_s = 0.01, kNoSidewaysShare = 0.02;

/** In the order of time, of several at one stamp the first. */
Trajectory trajectoryOf(std::vector<StampedPose> poses)
{
	std::stable_sort(poses.begin(), poses.end(), [](const StampedPose& a, const StampedPose& b) { return a.t_ns < b.t_ns; });
	Trajectory trajectory;
	for (const StampedPose& pose : poses)
		if (trajectory.empty() || pose.t_ns > trajectory.poses().back().t_ns) trajectory.push_back(pose);
	return trajectory;
}
}  // namespace

RosBagImport::RosBagImport(const RosBagFile& bag, const RosTopicMap& map, const ImportJob& job, bool record_time)
    : bag_(bag),
      job_(job),
      record_time_(record_time),
      map_(map),
      found_(bag, map, record_time),
      writer_(job.rawlog_path),
      order_(writer_, kReorder_s)
{
}

ImportResult RosBagImport::run()
{
	std::set<std::string> topics(found_.movingTransforms().begin(), found_.movingTransforms().end());
	if (!map_.general.ground_truth.empty()) topics.insert(map_.general.ground_truth);
	for (const RosSource& source : found_.sources()) topics.insert(source.mapping.topic);
	size_t total = 0, done = 0;
	for (const RosTopic& topic : bag_.topics())
		if (topics.count(topic.name) > 0) total += topic.messages;

	bag_.visit(topics,
	           [&](const rosbag::MessageInstance& message)
	           {
		           take(message);
		           if (!job_.proceed(static_cast<double>(++done) / static_cast<double>(total)))
			           throw Error("interrupted: " + job_.rawlog_path + " was not written");
		           return true;
	           });
	order_.finish();
	writer_.close();
	writeTracks();
	result_.duration_s = secondsBetween(order_.first_t_ns(), order_.last_t_ns());
	addNotes();
	return result_;
}

RosTopicMap RosBagImport::usedMap()
{
	RosTopicMap used = map_;
	used.general.base_frame = found_.baseFrame();
	for (size_t i = 0; i < used.topics.size(); ++i) used.topics[i] = found_.sources()[i].mapping;
	return used;
}

void RosBagImport::take(const rosbag::MessageInstance& message)
{
	const std::vector<std::string>& tf = found_.movingTransforms();
	if (std::find(tf.begin(), tf.end(), message.getTopic()) != tf.end())
	{
		found_.takeTransforms(message);
		return;
	}
	if (message.getTopic() == map_.general.ground_truth) takeTruth(message);
	for (const RosSource& source : found_.sources())
	{
		if (source.mapping.topic != message.getTopic()) continue;
		const RosHeader header = readHeader(message);
		Tally& tally = tallies_[source.mapping.label];
		++tally.messages;
		if (header.header_ns == 0 && !record_time_) ++tally.without_stamp;
		convert(message, source, stampOf(header, record_time_));
	}
}

void RosBagImport::convert(const rosbag::MessageInstance& message, const RosSource& source, int64_t t_ns)
{
	const std::string& label = source.mapping.label;
	mrpt::obs::CObservation::Ptr observation;
	if (source.type == "sensor_msgs/Imu")
	{
		observation = imuObservation(message, t_ns, source.T_OS, label);
		if (const ImuSample sample = readImu(message, t_ns); isFinite(sample))
			tallies_[label].force_sum_O += source.T_OS.R * sample.acc_m_s2;
		else
			++tallies_[label].not_finite;
		++result_.imu_samples;
	}
	else if (isOdometryType(source.type))
		observation = odometryOf(message, source, t_ns);
	else if (isImageType(source.type))
		observation = imageOf(message, source, t_ns);
	else if (source.type == "sensor_msgs/NavSatFix")
	{
		observation = fixObservation(message, t_ns, source.T_OS, label);
		++result_.gps_fixes;
		if (gps_label_.empty()) gps_label_ = label;
		if (label == gps_label_) takeFix(message, t_ns);
	}
	else if (source.type == "sensor_msgs/LaserScan")
	{
		observation = scanObservation(message, t_ns, source.T_OS, label);
		++result_.scans;
	}
	else
	{
		observation = cloudObservation(message, t_ns, source.T_OS, label);
		++result_.point_clouds;
	}
	if (observation) order_.push(observation);
}

mrpt::obs::CObservation::Ptr RosBagImport::odometryOf(const rosbag::MessageInstance& message, const RosSource& source, int64_t t_ns)
{
	Tally& tally = tallies_[source.mapping.label];
	if (source.type == "sensor_msgs/JointState")
	{
		const auto twist = source.wheels.at(t_ns);
		if (!twist || !tally.stamps.insert(t_ns).second) return nullptr;
		tally.moves = true;
		++result_.odometry_samples;
		return std::make_shared<mrpt::obs::CObservationOdometry>(makeOdometry(t_ns, *twist, {}, 0, 0, 0, source.mapping.label));
	}
	const auto observation = odometryObservation(message, t_ns, source.T_SO, source.mapping.label);
	const auto& odometry = dynamic_cast<const mrpt::obs::CObservationOdometry&>(*observation);
	const mrpt::math::TTwist2D& twist = odometry.velocityLocal;
	++result_.odometry_samples;
	if (std::isfinite(odometry.odometry.phi()))
		tally.first_to_last_m = std::max(tally.first_to_last_m, odometry.odometry.norm());
	else
		++tally.without_pose;
	if (std::isfinite(twist.vx) && std::isfinite(twist.omega))
	{
		tally.moves = tally.moves || std::abs(twist.vx) > 0 || std::abs(twist.omega) > 0;
		tally.forward_m2_s2 += twist.vx * twist.vx;
		if (std::isfinite(twist.vy)) tally.sideways_m2_s2 += twist.vy * twist.vy;
	}
	else
		++tally.not_finite;
	return observation;
}

mrpt::obs::CObservation::Ptr RosBagImport::imageOf(const rosbag::MessageInstance& message, const RosSource& source, int64_t t_ns)
{
	const std::string& label = source.mapping.label;
	Tally& tally = tallies_[label];
	const int64_t file_ns = roundedToRawlog(t_ns);
	if (!tally.stamps.insert(file_ns).second)
	{
		++tally.same_stamp;
		return nullptr;
	}
	const std::string extension = RosPictures::extension(message);
	const auto [width, height] = pictures_.write(message, writer_.imagePath(label, file_ns, extension));
	const CameraModel& camera = source.camera;
	const bool has_size = camera.width_px() > 0 && camera.height_px() > 0;
	if (has_size && (camera.width_px() != width || camera.height_px() != height))
		throw Error(source.mapping.topic + ": pictures of " + std::to_string(width) + "x" + std::to_string(height) + " pixels, but " +
		            source.mapping.camera_info + " is for " + std::to_string(camera.width_px()) + "x" + std::to_string(camera.height_px()) +
		            "; leave camera_info out of a --map");
	++result_.images;
	// The size is that of the picture also where the calibration is for none.
	const CameraModel used(width, height, camera.fx_px(), camera.fy_px(), camera.cx_px(), camera.cy_px(), camera.distortion(),
	                       camera.coefficients());
	return std::make_shared<mrpt::obs::CObservationImage>(
	    makeImage(t_ns, used, source.T_OS, RawlogWriter::imageName(label, file_ns, extension), label));
}

void RosBagImport::takeFix(const rosbag::MessageInstance& message, int64_t t_ns)
{
	const auto fix = readFix(message);
	if (!fix) return;
	if (!gps_origin_) gps_origin_ = fix;
	gps_.push_back({t_ns, Pose3(Eigen::Quaterniond::Identity(), eastNorthUp_m(*fix, *gps_origin_))});
}

void RosBagImport::takeTruth(const rosbag::MessageInstance& message)
{
	const RosHeader header = readHeader(message);
	const auto T_WS = readPose(message);
	if (!T_WS) return;
	truth_.push_back({stampOf(header, record_time_), *T_WS * found_.truth().T_SO.value_or(Pose3())});
}

void RosBagImport::writeTracks()
{
	if (!gps_.empty())
	{
		result_.gps_path = besideRawlog(job_.rawlog_path, kGpsEnding);
		trajectoryOf(gps_).saveTum(result_.gps_path);
	}
	if (!truth_.empty())
	{
		const Trajectory truth = trajectoryOf(truth_);
		result_.ground_truth_path = besideRawlog(job_.rawlog_path, kGroundTruthEnding);
		result_.ground_truth_poses = truth.size();
		result_.ground_truth_assumed = !found_.truth().T_SO;
		truth.saveTum(result_.ground_truth_path);
	}
}

void RosBagImport::addNotes()
{
	result_.notes = bag_.notesOnTypes(found_.topics());
	for (const auto& notes : {found_.notes(), found_.notesOnTransforms()})
		result_.notes.insert(result_.notes.end(), notes.begin(), notes.end());
	result_.notes.insert(result_.notes.end(), pictures_.notes().begin(), pictures_.notes().end());
	for (const RosSource& source : found_.sources()) addNotesOf(source, tallies_[source.mapping.label]);
	if (order_.outOfOrder() > 0)
		result_.notes.push_back("put in order: " + counted(order_.outOfOrder() - order_.late(), "observation") +
		                        " that came after one with a later stamp");
	if (order_.late() > 0)
		result_.notes.push_back(
		    mrpt::format("out of order, as more than %.0f s late: %s: does a sensor have another clock? --record-time takes the recorder's",
		                 kReorder_s, counted(order_.late(), "observation").c_str()));
	addGpsNote();
	for (const std::string& note : putAsideOthers(job_.rawlog_path, {result_.ground_truth_path, result_.gps_path}))
		result_.notes.push_back(note);
}

void RosBagImport::addGpsNote()
{
	if (result_.gps_fixes == 0) return;
	const std::string messages = counted(result_.gps_fixes, "message");
	result_.notes.push_back(
	    gps_origin_ ? mrpt::format("%s: positions of the antenna (not of O, and without an attitude), east-north-up of the first fix at "
	                               "%.8f %.8f deg, %.3f m; with a fix: %zu of %s",
	                               result_.gps_path.c_str(), gps_origin_->latitude_deg, gps_origin_->longitude_deg, gps_origin_->altitude_m,
	                               gps_.size(), messages.c_str())
	                : gps_label_ + ": " + messages + ", none of them with a fix: no " + besideRawlog(job_.rawlog_path, kGpsEnding));
}

void RosBagImport::note(const RosSource& source, const std::string& what)
{
	result_.notes.push_back(source.mapping.label + ": " + what);
}

void RosBagImport::addNotesOf(const RosSource& source, const Tally& tally)
{
	if (tally.without_stamp > 0)
		note(source,
		     mrpt::format("without a stamp: %zu of %zu headers; the time of recording was taken", tally.without_stamp, tally.messages));
	if (tally.same_stamp > 0) note(source, "left out: " + counted(tally.same_stamp, "picture") + " with the stamp of another one");
	if (source.placed && !source.mapping.sensorPose())
	{
		const auto motion = found_.frames().motionBetween(found_.baseFrame(), source.frame);
		if (motion.translation_m > 1e-3 || motion.rotation_rad > 1e-3)
			note(source, mrpt::format("tf moves it on the vehicle, by %.3f m and %.2f deg; its first pose was taken", motion.translation_m,
			                          motion.rotation_rad / kDegree));
	}
	if (isOdometryType(source.type)) addNotesOfOdometry(source, tally);
	if (source.type == "sensor_msgs/Imu") addNotesOfImu(source, tally);
}

void RosBagImport::addNotesOfOdometry(const RosSource& source, const Tally& tally)
{
	for (const std::string& line : source.wheels.notes()) note(source, line);
	if (!tally.moves && tally.first_to_last_m > 0) note(source, "all twists are zero, but the pose moves: use odometry_source = pose");
	if (tally.not_finite > 0)
		note(source,
		     mrpt::format("twists that are not finite: %zu of %zu; viwo-odometry will leave them out", tally.not_finite, tally.messages));
	if (tally.without_pose > 0)
		note(source, mrpt::format("poses that are none, with a value that is not finite or a quaternion whose length is not 1: %zu of %zu; "
		                          "they stand in the rawlog as NaN, which odometry_source = pose leaves out",
		                          tally.without_pose, tally.messages));
	const double twists = static_cast<double>(std::max<size_t>(1, tally.messages - tally.not_finite));
	const double forward_m_s = std::sqrt(tally.forward_m2_s2 / twists), sideways_m_s = std::sqrt(tally.sideways_m2_s2 / twists);
	if (sideways_m_s < kNoSideways_m_s || sideways_m_s < kNoSidewaysShare * forward_m_s) return;
	note(source,
	     mrpt::format("O moves sideways, by %.3f m/s where it moves forward by %.3f m/s (rms), but viwo-odometry takes O for a point that "
	                  "does not, the middle of the axle: %s",
	                  sideways_m_s, forward_m_s,
	                  source.T_SO ? ("set base_frame = " + source.frame + " if the wheels are there").c_str()
	                              : "set base_frame to the frame of the axle, or use no wheels (--mode vio)"));
}

void RosBagImport::addNotesOfImu(const RosSource& source, const Tally& tally)
{
	if (tally.not_finite > 0)
		note(source, mrpt::format("not finite: %zu of %zu samples; viwo-odometry will leave them out", tally.not_finite, tally.messages));
	if (tally.not_finite == tally.messages) return;
	const Eigen::Vector3d force_O = tally.force_sum_O / static_cast<double>(tally.messages - tally.not_finite);
	const double tilt_rad = std::acos(std::clamp(force_O.normalized().z(), -1.0, 1.0));
	if (force_O.norm() < 9 || force_O.norm() > 10.6)
		note(source, mrpt::format("the mean specific force is %.3f m/s^2, not 9.8: %s", force_O.norm(),
		                          force_O.norm() < 2 ? "in units of g, or gravity was taken off?" : "another unit?"));
	else if (tilt_rad > 20 * kDegree)
		note(source, mrpt::format("with its pose, gravity is %.0f deg from O's vertical: check that pose", tilt_rad / kDegree));
}
}  // namespace viwo
