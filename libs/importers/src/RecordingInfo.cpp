#include "CarmenLog.h"
#include "CsvFile.h"
#include "KittiOxts.h"
#include "RosBagHeader.h"
#include "StreamStatistics.h"
#include "TextLines.h"

#include <mrpt/obs/CObservationImage.h>
#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>
#include <viwo/importers/RecordingInfo.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <filesystem>
#include <fstream>

namespace viwo
{
namespace
{
namespace fs = std::filesystem;

void requireGoingOn(bool going_on, const std::string& path)
{
	if (!going_on) throw Error("interrupted: " + path + " was not looked through");
}

SensorRole roleOfClass(const std::string& name)
{
	if (name == "CObservationImage") return SensorRole::camera;
	if (name == "CObservationIMU") return SensorRole::imu;
	if (name == "CObservationOdometry") return SensorRole::wheels;
	if (name == "CObservation2DRangeScan") return SensorRole::lidar;
	return name == "CObservationGPS" ? SensorRole::gps : SensorRole::other;
}

std::string plainClassName(const mrpt::obs::CObservation& observation)
{
	const std::string name = observation.GetRuntimeClass()->className;
	const size_t colon = name.rfind(':');
	return colon == std::string::npos ? name : name.substr(colon + 1);
}

RecordingInfo inspectRawlog(const std::string& path, const std::function<bool(double)>& proceed)
{
	RecordingInfo info{path, "rawlog", {}, {}};
	RawlogReaderOptions options;
	options.max_stamp_jump_s = 0;
	options.allow_truncated = true;
	options.skip_missing_images = true;
	RawlogReader reader(path, options);
	StreamStatistics statistics;
	while (const auto observation = reader.next())
	{
		const std::string name = plainClassName(*observation);
		StreamInfo& stream = statistics.add(observation->sensorLabel, name, roleOfClass(name), nanosecondsOf(observation->timestamp));
		if (const auto* image = dynamic_cast<const mrpt::obs::CObservationImage*>(observation.get()))
			stream.calibrated = image->cameraParams.fx() > 0;
		requireGoingOn(proceed(reader.progress()), path);
	}
	info.streams = statistics.finish();
	if (reader.truncated()) info.notes.emplace_back("the file is truncated: this is what could be read");
	for (const auto& [key, sensor] : reader.counts().sensors)
	{
		for (StreamInfo& stream : info.streams)
			if (stream.name == key.first && stream.type == key.second) stream.backwards += sensor.late;
		if (sensor.missing_images > 0) info.notes.push_back(key.first + ": missing: " + counted(sensor.missing_images, "image file"));
		if (sensor.unstamped > 0) info.notes.push_back(key.first + ": without a stamp: " + counted(sensor.unstamped, "observation"));
	}
	return info;
}

/** By its content, whatever its name. */
bool isRawlog(const fs::path& path)
{
	std::error_code ignored;
	if (!fs::is_regular_file(path, ignored)) return false;  // a pipe is read only once
	try
	{
		const RawlogReader reader(path.string());
		return true;
	}
	catch (const Error&)
	{
		return false;
	}
}

/** Of all kinds the one that has no mark at its beginning, and so the last. */
CarmenLog readLogOfLastKind(const std::string& path)
try
{
	return readCarmenLog(path);
}
catch (const OtherFormat&)
{
	throw Error(path + ": is none of these: a rawlog, a ROS bag, a CARMEN log, a folder of EuRoC's or of KITTI's layout");
}

RecordingInfo inspectCarmen(const std::string& path)
{
	const CarmenLog log = readLogOfLastKind(path);
	StreamStatistics statistics;
	for (const CarmenScan& scan : log.scans)
	{
		statistics.add(scan.kind, "scan", SensorRole::lidar, scan.t_ns);
		statistics.add(scan.kind + " odometry", "pose", SensorRole::wheels, scan.t_ns);
	}
	for (const auto& odometry : log.odometry) statistics.add("ODOM", "pose", SensorRole::wheels, odometry.t_ns);
	return {path, "CARMEN log", statistics.finish(), {}};
}

RecordingInfo inspectEuroc(const fs::path& root)
{
	StreamStatistics statistics;
	const auto read = [&](const char* sensor, const char* type, SensorRole role, size_t columns)
	{
		const fs::path file = root / sensor / "data.csv";
		std::error_code ignored;
		if (!fs::exists(file, ignored)) return;
		for (const CsvRow& row : readStampedCsv(file.string(), columns, "t [ns], ...")) statistics.add(sensor, type, role, row.t_ns);
	};
	for (const char* camera : {"cam0", "cam1"}) read(camera, "image", SensorRole::camera, 1);
	read("imu0", "IMU", SensorRole::imu, 6);
	read("odom0", "speed", SensorRole::wheels, 2);
	read("state_groundtruth_estimate0", "pose", SensorRole::truth, 7);
	return {root.string(), "EuRoC sequence", statistics.finish(), {}};
}

RecordingInfo inspectKitti(const fs::path& root)
{
	StreamStatistics statistics;
	size_t missing_images = 0, missing_packets = 0;
	for (const KittiFrame& frame : readKittiFrames((root / "image_00").string(), "png", missing_images))
		statistics.add("image_00", "image", SensorRole::camera, frame.t_ns);
	for (const KittiFrame& frame : readKittiFrames((root / "oxts").string(), "txt", missing_packets))
	{
		statistics.add("oxts", "IMU", SensorRole::imu, frame.t_ns);
		statistics.add("oxts", "speed", SensorRole::wheels, frame.t_ns);
		statistics.add("oxts", "pose", SensorRole::truth, frame.t_ns);
	}
	RecordingInfo info{root.string(), "KITTI drive", statistics.finish(), {}};
	if (missing_images > 0) info.notes.push_back("missing: " + counted(missing_images, "image") + " of timestamps.txt");
	return info;
}

RecordingInfo inspectFolder(const std::string& path)
{
	const fs::path root(path);
	std::error_code ignored;
	for (const fs::path& folder : {root / "mav0", root})
		if (fs::is_directory(folder / "cam0", ignored) || fs::is_directory(folder / "imu0", ignored)) return inspectEuroc(folder);
	if (fs::is_directory(root / "image_00", ignored) && fs::is_directory(root / "oxts", ignored)) return inspectKitti(root);
	if (fs::exists(root / "metadata.yaml", ignored)) requireReadableBag(path);  // a ROS 2 bag: refused with its remedy
	throw Error(path + ": a folder of neither EuRoC's layout (cam0, imu0) nor KITTI's (image_00, oxts)");
}
}  // namespace

RecordingInfo inspectRecording(const std::string& path, const std::function<bool(double)>& proceed)
{
	std::error_code ignored;
	const fs::path name(path);
	if (!fs::exists(name, ignored)) throw Error(path + ": is not there; check the name");
	if (fs::is_directory(name, ignored)) return inspectFolder(path);
	if (name.extension() == ".rawlog") return inspectRawlog(path, proceed);
	std::string start(8, '\0');
	std::ifstream(path, std::ios::binary).read(start.data(), 8);
	const bool is_bag = start.compare(0, 4, "#ROS") == 0 || start.compare(0, 6, "SQLite") == 0 || start.compare(1, 4, "MCAP") == 0;
	if (is_bag || name.extension() == ".bag") return inspectRosBag(path, proceed);
	return isRawlog(name) ? inspectRawlog(path, proceed) : inspectCarmen(path);
}
}  // namespace viwo
