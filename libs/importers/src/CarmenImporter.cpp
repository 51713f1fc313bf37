#include "CarmenLog.h"
#include "OutputNames.h"
#include "StampRepair.h"

#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>
#include <viwo/core/Time.h>
#include <viwo/importers/CarmenImporter.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <algorithm>

namespace viwo
{
namespace
{
/** MRPT's scans lie symmetrically about their sensor's x axis: a half-open sweep is one of a sensor that is turned. */
Pose3 sensorPose(const CarmenScan& scan)
{
	const double middle_rad = scan.first_angle_rad + 0.5 * scan.step_rad * static_cast<double>(scan.ranges_m.size() - 1);
	return {Eigen::Quaterniond(Eigen::AngleAxisd(scan.T_OL.z() + middle_rad, Eigen::Vector3d::UnitZ())),
	        Eigen::Vector3d(scan.T_OL.x(), scan.T_OL.y(), 0)};
}

mrpt::obs::CObservationOdometry odometryAt(int64_t t_ns, const CarmenPose& pose, const std::string& label)
{
	mrpt::obs::CObservationOdometry odometry;
	odometry.timestamp = mrptTime(t_ns);
	odometry.sensorLabel = label;
	odometry.odometry = mrpt::poses::CPose2D(pose.x(), pose.y(), pose.z());
	return odometry;
}

template <class Item>
std::vector<int64_t> stampsOf(const std::vector<Item>& items)
{
	std::vector<int64_t> stamps;
	for (const Item& item : items) stamps.push_back(item.t_ns);
	return stamps;
}

std::string repairNote(const std::string& what, const RepairedStamps& stamps)
{
	return mrpt::format("stamps of %s run back %s; moved, by up to %.3f s, to keep the order of the file: %zu of %zu", what.c_str(),
	                    counted(stamps.backwards, "time").c_str(), static_cast<double>(stamps.largest_change_ns) * 1e-9, stamps.changed,
	                    stamps.t_ns.size());
}

void writeStamps(const std::string& path, const CarmenLog& log, const RepairedStamps& stamps)
{
	AtomicFile file(path);
	file.stream() << "rawlog_ns,original_s\n";
	for (size_t i = 0; i < log.scans.size(); ++i) file.stream() << stamps.t_ns[i] << "," << log.scans[i].stamp << "\n";
	file.commit();
}

/** The scans whose lines give the odometry: of several lasers the one that comes first. */
std::string leadingKind(const CarmenLog& log)
{
	for (const char* kind : {"FLASER", "ROBOTLASER1"})
		for (const CarmenScan& scan : log.scans)
			if (scan.kind == kind) return kind;
	return "RLASER";
}

void writeRawlog(const ImportJob& job, const CarmenLog& log, const RepairedStamps& scan_stamps, const RepairedStamps& odometry_stamps,
                 ImportResult& result)
{
	const std::string leading = leadingKind(log);
	RawlogWriter writer(job.rawlog_path);
	size_t next_odometry = 0;
	const auto writeOdometryUntil = [&](int64_t t_ns)
	{
		for (; next_odometry < log.odometry.size() && odometry_stamps.t_ns[next_odometry] <= t_ns; ++next_odometry)
			writer.write(odometryAt(odometry_stamps.t_ns[next_odometry], log.odometry[next_odometry].pose, "ODOM"));
	};
	for (size_t i = 0; i < log.scans.size(); ++i)
	{
		const CarmenScan& scan = log.scans[i];
		const int64_t t_ns = scan_stamps.t_ns[i];
		writeOdometryUntil(t_ns);
		if (scan.kind == leading)
		{
			writer.write(odometryAt(t_ns, scan.odometry, "ODOMETRY"));
			++result.odometry_samples;
		}
		const double aperture_rad = scan.step_rad * static_cast<double>(scan.ranges_m.size() - 1);
		writer.write(makeScan(t_ns, scan.ranges_m, aperture_rad, scan.max_range_m, sensorPose(scan), scan.kind));
		if (!job.proceed(static_cast<double>(i + 1) / static_cast<double>(log.scans.size())))
			throw Error("interrupted: " + job.rawlog_path + " was not written");
	}
	writeOdometryUntil(std::numeric_limits<int64_t>::max());
	writer.close();
	result.odometry_samples += log.odometry.size();
}
}  // namespace

ImportResult importCarmen(const ImportJob& job)
{
	CarmenLog log = readCarmenLog(job.folder);
	const auto empty = [](const CarmenScan& scan) { return scan.ranges_m.empty(); };
	const size_t scans_read = log.scans.size();
	log.scans.erase(std::remove_if(log.scans.begin(), log.scans.end(), empty), log.scans.end());
	if (log.scans.empty()) throw Error(job.folder + ": all scans are without readings (" + std::to_string(scans_read) + " of them)");

	ImportResult result;
	if (log.scans.size() < scans_read)
		result.notes.push_back("left out: " + counted(scans_read - log.scans.size(), "scan") + " without readings");
	const RepairedStamps scan_stamps = repairStamps(stampsOf(log.scans)), odometry_stamps = repairStamps(stampsOf(log.odometry));
	if (scan_stamps.backwards > 0) result.notes.push_back(repairNote("scans", scan_stamps));
	if (odometry_stamps.backwards > 0) result.notes.push_back(repairNote("ODOM lines", odometry_stamps));
	for (const auto& [kind, count] : log.other_lines) result.notes.push_back("left out: " + counted(count, kind + " line"));

	writeRawlog(job, log, scan_stamps, odometry_stamps, result);
	result.stamps_path = besideRawlog(job.rawlog_path, kStampsEnding);
	writeStamps(result.stamps_path, log, scan_stamps);
	for (const std::string& note : putAsideOthers(job.rawlog_path, {result.stamps_path})) result.notes.push_back(note);
	result.scans = log.scans.size();
	result.duration_s = secondsBetween(scan_stamps.t_ns.front(), scan_stamps.t_ns.back());
	return result;
}
}  // namespace viwo
