#include "KittiCalibration.h"
#include "KittiOxts.h"
#include "RawlogAssembler.h"

#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>
#include <viwo/importers/KittiImporter.h>

#include <filesystem>
#include <random>

namespace viwo
{
namespace
{
/** Height of the IMU over the ground in KITTI's car (Geiger et al., Fig. 3). */
constexpr double kImuHeight_m = 0.93;

std::string missingNote(const std::string& what, size_t missing, size_t found)
{
	return "left out, as not there: " + std::to_string(missing) + " of " + counted(missing + found, what);
}

void readImages(const std::string& folder, Recording& recording, std::vector<std::string>& notes)
{
	size_t missing = 0;
	for (KittiFrame& frame : readKittiFrames(folder + "/image_00", "png", missing))
		recording.images.push_back({frame.t_ns, std::move(frame.path)});
	if (missing > 0) notes.push_back(missingNote("image", missing, recording.images.size()));
}

void readOxts(const std::string& folder, const KittiOptions& options, Recording& recording, std::vector<std::string>& notes)
{
	size_t missing = 0;
	std::vector<OxtsPacket> packets;
	for (const KittiFrame& frame : readKittiFrames(folder + "/oxts", "txt", missing)) packets.push_back(readOxtsPacket(frame));
	if (missing > 0) notes.push_back(missingNote("OXTS packet", missing, packets.size()));

	std::mt19937_64 random(options.seed);
	std::normal_distribution<double> normal;
	const Pose3 T_IO = recording.T_OB.inverse();
	for (const OxtsPacket& packet : packets)
	{
		recording.imu.push_back(packet.imu);
		WheelTwist twist = packet.twist;
		twist.v_m_s = options.speed_scale * twist.v_m_s + options.speed_noise_m_s * normal(random);
		recording.odometry.push_back({packet.t_ns, twist});
		recording.ground_truth.push_back({packet.t_ns, poseOf(packet, packets.front()) * T_IO});
	}
}
}  // namespace

ImportResult importKitti(const ImportJob& job, const KittiOptions& options)
{
	std::error_code ignored;
	if (!std::filesystem::is_directory(job.folder, ignored)) throw Error(job.folder + ": no such folder");
	std::vector<std::string> notes;
	Recording recording;
	readImages(job.folder, recording, notes);
	const KittiCalibration calibration = readKittiCalibration(job.folder, imageSize(recording.images.front().path));
	recording.camera = calibration.camera;
	recording.T_OB = Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, kImuHeight_m));
	recording.T_OC = recording.T_OB * calibration.T_IC;
	readOxts(job.folder, options, recording, notes);
	notes.emplace_back("speeds and yaw rates are values at their stamp: set velocity_meaning = instantaneous in the configuration");

	ImportResult result = writeRecording(recording, job);
	result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
	return result;
}
}  // namespace viwo
