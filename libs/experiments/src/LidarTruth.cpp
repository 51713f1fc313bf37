#include <viwo/core/Error.h>
#include <viwo/experiments/LidarTruth.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace viwo::experiments
{
namespace
{
constexpr double kNever = std::numeric_limits<double>::infinity();

double xyAgainst(const Trajectory& truth, const DriveErrors& drive)
{
	if (!drive.problem.empty()) return kNever;
	return evaluate(truth, Trajectory::loadTum(drive.folder + "/trajectory.tum"), EvaluationOptions()).ate_xy_m;
}

LidarDrive lidarDrive(const Runner& runner, const std::string& sequence, uint64_t seed)
{
	const Outcome outcome = runner.truthOutcome(sequenceLog(sequence, seed));
	LidarDrive drive;
	drive.sequence = sequence;
	drive.seed = seed;
	drive.problem = outcome.error;
	drive.folder = outcome.folder;
	if (outcome.failed()) return drive;
	const TrajectoryErrors errors = outcome.errors();
	drive.truth_xy_m = errors.ate_xy_m;
	drive.truth_yaw_deg = errors.yaw_rmse_deg;
	return drive;
}

double medianOf(const std::vector<LidarDrive>& drives, const std::string& sequence, const std::function<double(const LidarDrive&)>& figure)
{
	std::vector<double> values;
	for (const LidarDrive& drive : drives)
		if (drive.sequence == sequence) values.push_back(drive.problem.empty() ? figure(drive) : kNever);
	return median(values);
}

double ofMode(const LidarDrive& drive, const std::string& mode)
{
	const auto at = drive.ate_xy_m.find(mode);
	return at == drive.ate_xy_m.end() ? kNever : at->second;
}

std::string cell(double value, int decimals)
{
	return std::isfinite(value) ? fixed(value, decimals) : "-";
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
		for (size_t i = 0; i < request.seeds.size(); ++i)
		{
			LidarDrive drive = lidarDrive(runner, sequence, request.seeds[i]);
			if (drive.problem.empty())
			{
				const Trajectory truth = Trajectory::loadTum(drive.folder + "/trajectory.tum");
				for (const DriveResult& result : drives)
					if (result.sequence == sequence && result.variant.overrides.empty())
						drive.ate_xy_m[result.variant.name] = xyAgainst(truth, result.seeds[i]);
			}
			list.push_back(std::move(drive));
		}
	return list;
}

Table table1Lidar(const std::vector<LidarDrive>& drives)
{
	std::vector<Table::Column> columns{{"sequence", "", true}};
	for (const Variant& mode : modes()) columns.push_back({mode.name + " x-y", "m"});
	columns.push_back({"lidar's own error x-y", "m"});
	columns.push_back({"and in yaw", "deg"});
	Table table(columns);
	std::string last;
	for (const LidarDrive& drive : drives)
	{
		if (drive.sequence == last) continue;
		last = drive.sequence;
		std::vector<std::string> cells{last};
		std::vector<double> figures;
		for (const Variant& mode : modes())
		{
			figures.push_back(medianOf(drives, last, [&](const LidarDrive& d) { return ofMode(d, mode.name); }));
			cells.push_back(cell(figures.back(), 3));
		}
		const size_t best = static_cast<size_t>(std::min_element(figures.begin(), figures.end()) - figures.begin());
		cells.push_back(cell(medianOf(drives, last, [](const LidarDrive& d) { return d.truth_xy_m; }), 3));
		cells.push_back(cell(medianOf(drives, last, [](const LidarDrive& d) { return d.truth_yaw_deg; }), 2));
		table.addRow(cells, std::isfinite(figures[best]) ? std::set<size_t>{1 + best} : std::set<size_t>{});
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
