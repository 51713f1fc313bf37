#include <viwo/core/Error.h>
#include <viwo/experiments/LidarTruth.h>

#include <map>

#include "Figures.h"

namespace viwo::experiments
{
namespace
{
/** Against the trajectory from the scans, x-y, m. */
double ateOf(const DriveErrors& run, const Trajectory& lidar)
{
	if (run.open) return kOpen;
	if (!run.problem.empty()) return kFailed;
	return evaluate(lidar, *run.estimate, EvaluationOptions()).ate_xy_m;
}

/** @param seed index in the lists of the drives. @throws Error where nothing can be compared. */
void judge(const Outcome& outcome, const std::vector<DriveResult>& drives, size_t seed, LidarDrive& drive)
{
	const Trajectory lidar = outcome.trajectory();
	const TrajectoryErrors own = evaluate(outcome.truth(), lidar, EvaluationOptions());
	drive.truth_xy_m = own.ate_xy_m;
	drive.truth_yaw_deg = own.yaw_rmse_deg;
	for (const DriveResult& result : drives)
		if (result.sequence == drive.sequence && result.variant.overrides.empty())
			drive.ate_xy_m[result.variant.name] = ateOf(result.seeds[seed], lidar);
}

LidarDrive lidarDrive(const Outcome& outcome, const std::string& sequence, const std::vector<DriveResult>& drives, const Request& request,
                      size_t seed)
{
	LidarDrive drive;
	drive.sequence = sequence;
	drive.seed = request.seeds[seed];
	drive.problem = outcome.error;
	drive.open = outcome.open;
	drive.folder = outcome.folder;
	if (outcome.failed()) return drive;
	try
	{
		judge(outcome, drives, seed, drive);
	}
	catch (const Error& e)
	{
		drive.problem = e.what();
	}
	return drive;
}

double medianOf(const std::vector<LidarDrive>& drives, const std::string& sequence, const std::function<double(const LidarDrive&)>& figure)
{
	std::vector<double> values;
	for (const LidarDrive& drive : drives)
		if (drive.sequence == sequence) values.push_back(drive.open ? kOpen : drive.problem.empty() ? figure(drive) : kFailed);
	return median(values);
}
}  // namespace

void planLidarTruth(Runner& runner, const Request& request)
{
	if (request.tables.count(1) == 0) return;
	for (const std::string& sequence : request.sequences)
		for (const uint64_t seed : request.seeds) runner.wantTruth(sequenceLog(sequence, seed));
}

std::vector<LidarDrive> lidarDrives(const Runner& runner, const Request& request, const std::vector<DriveResult>& drives)
{
	std::vector<LidarDrive> list;
	if (request.tables.count(1) == 0) return list;
	for (const std::string& sequence : request.sequences)
		for (size_t seed = 0; seed < request.seeds.size(); ++seed)
			list.push_back(lidarDrive(runner.truthOutcome(sequenceLog(sequence, request.seeds[seed])), sequence, drives, request, seed));
	return list;
}

Table table1Lidar(const std::vector<LidarDrive>& drives)
{
	std::vector<Table::Column> columns{{"sequence", "", true}};
	for (const Variant& mode : modes()) columns.push_back({mode.name + " x-y", "m"});
	columns.push_back({"lidar's own error x-y", "m"});
	columns.push_back({"and in yaw", "deg"});
	Table table(columns);
	for (const std::string& sequence : sequencesOf(drives))
	{
		std::vector<std::string> cells{sequence};
		std::vector<double> figures;
		for (const Variant& mode : modes())
		{
			figures.push_back(medianOf(drives, sequence, [&](const LidarDrive& d) { return d.ate_xy_m.at(mode.name); }));
			cells.push_back(cell(figures.back(), 3));
		}
		std::set<size_t> bold;
		for (const size_t mode : smallest(figures, 3)) bold.insert(1 + mode);
		cells.push_back(cell(medianOf(drives, sequence, [](const LidarDrive& d) { return d.truth_xy_m; }), 3));
		cells.push_back(cell(medianOf(drives, sequence, [](const LidarDrive& d) { return d.truth_yaw_deg; }), 2));
		table.addRow(cells, bold);
	}
	return table;
}

Json table1LidarJson(const std::vector<LidarDrive>& drives)
{
	Json rows = Json::array();
	for (const LidarDrive& drive : drives)
	{
		Json row{{"sequence", drive.sequence}, {"seed", drive.seed}, {"problem", drive.problem}};
		if (drive.problem.empty())
		{
			row["ground_truth"] = {{"ate_xy_m", drive.truth_xy_m}, {"yaw_rmse_deg", drive.truth_yaw_deg}};
			for (const auto& [mode, ate_m] : drive.ate_xy_m) row["ate_xy_m"][mode] = std::isfinite(ate_m) ? Json(ate_m) : Json();
		}
		rows.push_back(row);
	}
	return rows;
}
}  // namespace viwo::experiments
