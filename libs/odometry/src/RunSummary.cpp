#include "RunSummary.h"

#include "CalibrationSummary.h"

#include <viwo/core/AtomicFile.h>
#include <viwo/core/PeakMemory.h>
#include <viwo/core/Time.h>

#include <nlohmann/json.hpp>

namespace viwo
{
namespace
{
using Json = nlohmann::ordered_json;

Json stagesJson(const StageTimes& times)
{
	Json stages = Json::object();
	for (const std::string& name : times.stages())
	{
		const StageTimes::Statistics s = times.statistics(name);
		stages[name] = {{"calls", s.calls}, {"mean", s.mean_ms}, {"median", s.median_ms}, {"p95", s.p95_ms}, {"max", s.max_ms}};
	}
	return stages;
}

Json observationsJson(const Odometry& odometry, const RawlogCounts& counts)
{
	Json observations = Json::object();
	for (const auto& [key, sensor] : counts.sensors)
	{
		Json& entry = observations[key.first];
		entry["class"] = key.second;
		entry["read"] = sensor.read;
		Json rejected = Json::object();
		if (sensor.late) rejected["late"] = sensor.late;
		if (sensor.unstamped) rejected["unstamped"] = sensor.unstamped;
		if (sensor.stamp_jumps) rejected["stamp_jump"] = sensor.stamp_jumps;
		if (sensor.missing_images) rejected["missing_image_file"] = sensor.missing_images;
		const auto used = odometry.observationCounts().find(key.first);
		entry["used"] = used == odometry.observationCounts().end() ? 0 : used->second.accepted;
		if (used != odometry.observationCounts().end())
			for (const auto& [reason, count] : used->second.rejected) rejected[reason] = count;
		entry["rejected"] = rejected;
	}
	return observations;
}

Json statusJson(const Odometry& odometry)
{
	Json changes = Json::array();
	for (const StatusChange& c : odometry.statusChanges())
		changes.push_back({{"t_s", secondsBetween(odometry.firstFrame_ns(), c.t_ns)},
		                   {"from", toString(c.from)},
		                   {"to", toString(c.to)},
		                   {"cause", c.cause}});
	return changes;
}

/** Seconds from the first frame to the first time in a status; null where it never was. */
Json timeToStatus(const Odometry& odometry, Status status)
{
	for (const StatusChange& c : odometry.statusChanges())
		if (c.to == status) return secondsBetween(odometry.firstFrame_ns(), c.t_ns);
	return nullptr;
}

Json gapsJson(const GapLog& log, int64_t first_frame_ns)
{
	Json gaps = Json::array();
	for (const GapLog::Gap& gap : log.gaps())
		gaps.push_back({{"label", gap.label}, {"t_s", secondsBetween(first_frame_ns, gap.begin_ns)}, {"duration_s", gap.duration_s}});
	return gaps;
}

Json vectorJson(const Eigen::Vector3d& v)
{
	return {v.x(), v.y(), v.z()};
}

/** What was known when the first pose was given: how well the estimator started. */
Json firstPoseJson(const FrameEstimate& first, const Calibration& calibration)
{
	const Eigen::Quaterniond& q = first.T_WO.R;
	return {{"t_ns", first.t_ns},
	        {"status", toString(first.status)},
	        {"R_WO_xyzw", {q.x(), q.y(), q.z(), q.w()}},
	        {"v_WB_in_B_m_s", vectorJson(first.state.T_WB.R.conjugate() * first.state.v_WB)},
	        {"gyro_bias_in_O_rad_s", vectorJson(calibration.T_OB.R * first.state.b_g)},
	        {"acc_bias_in_O_m_s2", vectorJson(calibration.T_OB.R * first.state.b_a)}};
}

/** Share of the duration in which poses follow each other; what viwo-evaluate finds, too, with its default gap. */
double coverage(const Trajectory& trajectory, double duration_s)
{
	constexpr double kMaxGap_s = 0.5;
	std::vector<int64_t> stamps_ns;
	for (const StampedPose& pose : trajectory.poses()) stamps_ns.push_back(pose.t_ns);
	return duration_s > 0 ? coveredDuration_s(stamps_ns, kMaxGap_s) / duration_s : 0;
}

/** Whether frames become slower, or the program larger, as the log goes on. */
Json minutesJson(const MinuteLog& log, const StageTimes& times)
{
	Json minutes = Json::array();
	size_t begin = 0;
	for (const MinuteLog::Minute& minute : log.minutes())
	{
		const StageTimes::Statistics s = times.statistics("frame", begin, begin + minute.frames);
		minutes.push_back(
		    {{"minute", minute.number}, {"frames", minute.frames}, {"frame_median_ms", s.median_ms}, {"rss_mb", minute.rss_mb}});
		begin += minute.frames;
	}
	return minutes;
}
}  // namespace

void writeSummary(const std::string& path, const OdometryRunOptions& options, const OdometryRunResult& result, const Odometry& odometry,
                  const RunOutputs& outputs, const RawlogCounts& counts, const MinuteLog& minutes, const GapLog& gaps)
{
	const EstimatorCounters n = odometry.counters();
	Json j;
	j["program"] = "viwo-odometry " VIWO_VERSION;
	j["rawlog"] = options.rawlogs.size() == 1 ? Json(options.rawlogs.front()) : Json(options.rawlogs);
	j["config"] = options.config_path;
	j["mode"] = modeNames()[static_cast<size_t>(options.odometry.estimator.mode)];
	j["pose_frame"] = options.pose_frame == PoseFrame::O ? "O" : options.pose_frame == PoseFrame::B ? "B" : "C";
	j["status"] = result.final_status;
	j["interrupted"] = result.interrupted;
	j["frames"] = result.frames;
	j["poses"] = result.poses;
	j["keyframes"] = n.keyframes;
	j["duration_s"] = result.duration_s;
	j["path_length_m"] = result.path_length_m;
	j["wheel_travel_m"] = result.wheel_travel_m;
	j["doubt"] = result.doubt;
	j["first_pose_s"] = outputs.poses() > 0 ? Json(secondsBetween(odometry.firstFrame_ns(), outputs.firstPose_ns())) : Json();
	j["first_pose"] = outputs.poses() > 0 ? firstPoseJson(outputs.first(), *odometry.calibration()) : Json();
	j["initialization_time_s"] = timeToStatus(odometry, Status::tracking);
	j["coverage"] = coverage(odometry.trajectory(), result.duration_s);
	j["reinitializations"] = n.reinitializations;
	j["slip_events"] = n.slip_events;
	j["standstills"] = n.standstills;
	j["imu_gaps"] = gaps.count(options.odometry.rawlog.imu_label);
	j["wheel_gaps"] = gaps.count(options.odometry.rawlog.odometry_label);
	j["status_changes"] = statusJson(odometry);
	j["gaps"] = gapsJson(gaps, odometry.firstFrame_ns());
	j["calibration"] = calibrationJson(odometry, options.odometry);
	j["observations"] = observationsJson(odometry, counts);
	j["wall_time_s"] = result.wall_time_s;
	j["realtime_factor"] = result.wall_time_s > 0 ? result.duration_s / result.wall_time_s : 0.0;
	j["replay_speed"] = options.replay_speed > 0 ? Json(options.replay_speed) : Json();
	j["largest_lag_s"] = options.replay_speed > 0 ? Json(result.largest_lag_s) : Json();
	j["peak_rss_mb"] = peakMemory_mb();
	j["stages_ms"] = stagesJson(odometry.stageTimes());
	j["minutes"] = minutesJson(minutes, odometry.stageTimes());
	writeAtomically(path, j.dump(2) + "\n");
}
}  // namespace viwo
