#include "RosBagImport.h"

#include "RosInstance.h"

#include <mrpt/core/format.h>
#include <viwo/core/NumberText.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace viwo
{
namespace
{
/** Observations are sorted within this; a sensor whose data come later than that has another clock. */
constexpr double kReorder_s = 10;

std::string besideRawlog(const std::string& rawlog_path, const char* ending)
{
	std::filesystem::path path(rawlog_path);
	return path.replace_filename(path.stem().string() + ending).string();
}

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
	std::set<std::string> topics{"/tf"};
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
	if (message.getTopic() == "/tf")
	{
		readTransforms(message, [this](const std::string& parent, const std::string& child, const Pose3& T)
		               { found_.frames().add(parent, child, T); });
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
		const auto sample = tally.wheels.push(message, t_ns, source.mapping);
		if (!sample) return nullptr;
		tally.moves = true;
		++result_.odometry_samples;
		return std::make_shared<mrpt::obs::CObservationOdometry>(makeOdometry(t_ns, sample->twist, {}, 0, 0, 0, source.mapping.label));
	}
	const auto observation = odometryObservation(message, t_ns, source.mapping.label);
	const auto& odometry = dynamic_cast<const mrpt::obs::CObservationOdometry&>(*observation);
	tally.moves = tally.moves || std::abs(odometry.velocityLocal.vx) > 0 || std::abs(odometry.velocityLocal.omega) > 0;
	tally.first_to_last_m = std::max(tally.first_to_last_m, odometry.odometry.norm());
	++result_.odometry_samples;
	return observation;
}

mrpt::obs::CObservation::Ptr RosBagImport::imageOf(const rosbag::MessageInstance& message, const RosSource& source, int64_t t_ns)
{
	const std::string& label = source.mapping.label;
	Tally& tally = tallies_[label];
	const int64_t file_ns = roundedToRawlog(t_ns);
	if (!tally.image_stamps.insert(file_ns).second)
	{
		++tally.same_stamp;
		return nullptr;
	}
	const std::string extension = RosPictures::extension(message);
	const auto [width, height] = pictures_.write(message, writer_.imagePath(label, file_ns, extension));
	const CameraModel& camera = source.camera;
	if (camera.width_px() > 0 && (camera.width_px() != width || camera.height_px() != height))
		throw Error(source.mapping.topic + ": pictures of " + std::to_string(width) + "x" + std::to_string(height) + " pixels, but " +
		            source.mapping.camera_info + " is for " + std::to_string(camera.width_px()) + "x" + std::to_string(camera.height_px()) +
		            "; leave camera_info out of a --map");
	++result_.images;
	const CameraModel used = camera.width_px() > 0 ? camera : CameraModel(width, height, 0, 0, 0, 0);
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
		result_.gps_path = besideRawlog(job_.rawlog_path, "_gps.tum");
		trajectoryOf(gps_).saveTum(result_.gps_path);
	}
	if (truth_.empty()) return;
	const Trajectory truth = trajectoryOf(truth_);
	result_.ground_truth_path = besideRawlog(job_.rawlog_path, "_ground_truth.tum");
	result_.ground_truth_poses = truth.size();
	result_.ground_truth_assumed = !found_.truth().T_SO;
	truth.saveTum(result_.ground_truth_path);
}

void RosBagImport::addNotes()
{
	result_.notes = found_.notes();
	result_.notes.insert(result_.notes.end(), pictures_.notes().begin(), pictures_.notes().end());
	for (const RosSource& source : found_.sources()) addNotesOf(source, tallies_[source.mapping.label]);
	if (order_.outOfOrder() > 0)
		result_.notes.push_back("put in order: " + counted(order_.outOfOrder() - order_.late(), "observation") +
		                        " that came after one with a later stamp");
	if (order_.late() > 0)
		result_.notes.push_back(
		    mrpt::format("out of order, as more than %.0f s late: %s: does a sensor have another clock? --record-time takes the recorder's",
		                 kReorder_s, counted(order_.late(), "observation").c_str()));
	if (gps_origin_)
		result_.notes.push_back(
		    mrpt::format("%s: positions of the antenna (not of O, and without an attitude), east-north-up of the first fix at %.8f "
		                 "%.8f deg, %.3f m; with a fix: %zu of %s",
		                 result_.gps_path.c_str(), gps_origin_->latitude_deg, gps_origin_->longitude_deg, gps_origin_->altitude_m,
		                 gps_.size(), counted(result_.gps_fixes, "message").c_str()));
}

void RosBagImport::addNotesOf(const RosSource& source, const Tally& tally)
{
	const char* label = source.mapping.label.c_str();
	const auto note = [this](const std::string& line) { result_.notes.push_back(line); };
	if (tally.without_stamp > 0)
		note(mrpt::format("%s: without a stamp: %zu of %zu headers; the time of recording was taken", label, tally.without_stamp,
		                  tally.messages));
	if (tally.same_stamp > 0)
		note(mrpt::format("%s: left out: %s with the stamp of another one", label, counted(tally.same_stamp, "picture").c_str()));
	if (isOdometryType(source.type) && !tally.moves && tally.first_to_last_m > 0)
		note(mrpt::format("%s: all twists are zero, but the pose moves: use odometry_source = pose", label));
	if (source.placed)
	{
		const auto motion = found_.frames().motionBetween(found_.baseFrame(), source.frame);
		if (!source.mapping.sensorPose() && (motion.translation_m > 1e-3 || motion.rotation_rad > 1e-3))
			note(mrpt::format("%s: tf moves it on the vehicle, by %.3f m and %.2f deg; its first pose was taken", label,
			                  motion.translation_m, motion.rotation_rad / kDegree));
	}
	if (source.type != "sensor_msgs/Imu") return;
	if (tally.not_finite > 0)
		note(
		    mrpt::format("%s: not finite: %zu of %zu samples; viwo-odometry will leave them out", label, tally.not_finite, tally.messages));
	if (tally.not_finite == tally.messages) return;
	const Eigen::Vector3d force_O = tally.force_sum_O / static_cast<double>(tally.messages - tally.not_finite);
	const double tilt_rad = std::acos(std::clamp(force_O.normalized().z(), -1.0, 1.0));
	if (force_O.norm() < 9 || force_O.norm() > 10.6)
		note(mrpt::format("%s: the mean specific force is %.3f m/s^2, not 9.8: %s", label, force_O.norm(),
		                  force_O.norm() < 2 ? "in units of g, or gravity was taken off?" : "another unit?"));
	else if (tilt_rad > 20 * kDegree)
		note(mrpt::format("%s: with its pose, gravity is %.0f deg from O's vertical: check that pose", label, tilt_rad / kDegree));
}
}  // namespace viwo
