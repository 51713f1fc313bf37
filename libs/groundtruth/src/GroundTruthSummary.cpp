#include "GroundTruthSummary.h"

#include <viwo/core/AtomicFile.h>
#include <viwo/core/PeakMemory.h>
#include <viwo/core/Time.h>

#include <nlohmann/json.hpp>

namespace viwo::gt
{
namespace
{
using Json = nlohmann::ordered_json;

Json orNull(const std::optional<double>& value, double factor = 1)
{
	return value ? Json(*value * factor) : Json(nullptr);
}

}  // namespace

void writeSummary(const std::string& path, const GroundTruthRunOptions& options, const Session& session, const Solution& solution,
                  const std::optional<WithoutOdometry>& without, const GroundTruthRunResult& result)
{
	Json j;
	j["program"] = "viwo-groundtruth " VIWO_VERSION;
	j["rawlogs"] = options.rawlogs;
	j["config"] = options.config_path;
	j["scan_label"] = session.scan_label;
	j["frame"] = "O";
	j["scans"] = result.scans;
	j["key_scans"] = result.key_scans;
	j["duration_s"] = secondsBetween(session.scans.front().t_ns, session.scans.back().t_ns);
	j["path_length_m"] = result.path_length_m;
	j["range_noise_m"] = session.range_noise_m;
	j["guess"] = session.has_odometry ? (session.has_imu ? "odometry, yaw by gyroscope" : "odometry") : "constant velocity";
	j["window_searches"] = solution.window_searches;
	j["flags"] = {{"good", result.good}, {"degenerate", result.degenerate}, {"odometry_only", result.odometry_only}};
	j["loops"] = {{"compared", solution.loops.searched},
	              {"matched", solution.loops.matched},
	              {"accepted", solution.loops.accepted},
	              {"rejected", solution.loops.rejected},
	              {"unconfirmed", solution.loops.unconfirmed}};
	j["graph_edges"] = solution.edges.size();
	if (solution.holdout)
	{
		const HoldoutErrors& h = *solution.holdout;
		j["holdout"] = {
		    {"scans", h.scans}, {"median_m", h.median_m}, {"p95_m", h.p95_m}, {"median_deg", h.median_deg}, {"p95_deg", h.p95_deg}};
	}
	const OdometryCalibration& c = solution.calibration;
	j["odometry"] = {{"distance_scale", orNull(c.distance_scale)},
	                 {"distance_scale_deviation", orNull(c.distance_scale_deviation)},
	                 {"turn_scale", orNull(c.turn_scale)},
	                 {"time_offset_s", orNull(c.time_offset_s)},
	                 {"time_offset_deviation_s", orNull(c.time_offset_deviation_s)},
	                 {"time_offset_significant", c.offsetIsSignificant()}};
	j["odometry"]["jumps"] = session.odometry_jumps;
	j["odometry"]["contradicted"] = solution.contradicted;
	j["odometry"]["left_out"] = session.odometry_left_out;
	if (session.has_imu) j["odometry"]["gyro_bias_rad_s"] = session.gyro_bias_rad_s + c.gyro_bias_rad_s.value_or(0);
	j["lidar_yaw_deg"] = orNull(c.lidar_yaw_rad, 180 / M_PI);
	j["odometry_edges"] = options.options.graph.odometry_edges;
	if (without) j["against_odometry_edges"] = {{"mean_m", without->mean_m}, {"max_m", without->max_m}, {"mean_deg", without->mean_deg}};
	j["notes"] = result.notes;
	j["threads"] = options.threads;
	j["wall_time_s"] = result.wall_time_s;
	j["cpu_time_s"] = result.cpu_time_s;
	j["peak_memory_mb"] = peakMemory_mb();
	writeAtomically(path, j.dump(2) + "\n");
}
}  // namespace viwo::gt
