#include <viwo/evaluation/Report.h>
#include <viwo/evaluation/Table.h>

#include <algorithm>

namespace viwo
{
namespace
{
Json toJson(const Consistency& c)
{
	return {{"anees_position", c.position.average()},
	        {"anees_yaw", c.yaw.average()},
	        {"anees_pose", c.pose.average()},
	        {"nees_poses", c.pose.poses},
	        {"nees_invalid", c.invalid},
	        {"nees_without_covariance", c.without_covariance}};
}

std::string shortNumber(double value)
{
	std::string text = fixed(value, 3);
	text.erase(text.find_last_not_of('0') + 1);
	if (text.back() == '.') text.pop_back();
	return text;
}
}  // namespace

Json toJson(const EstimateReport& report)
{
	const TrajectoryErrors& e = report.errors;
	Json json = {{"estimate", report.name},
	             {"ate_xy_m", e.ate_xy_m},
	             {"ate_z_m", e.ate_z_m},
	             {"ate_xyz_m", e.ate_xyz_m},
	             {"ate_median_m", e.ate_median_m},
	             {"ate_max_m", e.ate_max_m},
	             {"ate_percent", e.length_m > 0 ? Json(100 * e.ate_xyz_m / e.length_m) : Json()},
	             {"yaw_rmse_deg", e.yaw_rmse_deg},
	             {"rotation_rmse_deg", e.rotation_rmse_deg},
	             {"rpe_trans_percent", e.rpe_trans_percent},
	             {"rpe_rot_deg_per_m", e.rpe_rot_deg_per_m},
	             {"rpe_distance_pairs", e.rpe_distance_pairs},
	             {"rpe_interval_trans_m", e.rpe_interval_trans_m},
	             {"rpe_interval_rot_deg", e.rpe_interval_rot_deg},
	             {"rpe_interval_pairs", e.rpe_interval_pairs},
	             {"length_m", e.length_m},
	             {"estimate_length_m", e.estimate_length_m},
	             {"matched", e.matched},
	             {"unmatched", e.unmatched},
	             {"matched_duration_s", e.matched_duration_s},
	             {"coverage", e.coverage},
	             {"scale", e.alignment.scale}};
	if (report.consistency) json.update(toJson(*report.consistency));
	return json;
}

Json toJson(const std::string& reference, const EvaluationOptions& options, const std::vector<EstimateReport>& reports)
{
	Json json = {{"reference", reference},
	             {"alignment", toString(options.alignment)},
	             {"max_gap_s", options.max_gap_s},
	             {"rpe_interval_s", options.rpe_interval_s},
	             {"rpe_distance_m", options.rpe_distance_m}};
	if (reports.size() == 1) json.update(toJson(reports.front()));
	json["estimates"] = Json::array();
	for (const EstimateReport& report : reports) json["estimates"].push_back(toJson(report));
	return json;
}

std::string toTable(const std::vector<EstimateReport>& reports, const EvaluationOptions& options)
{
	const std::string interval = shortNumber(options.rpe_interval_s) + " s", distance = shortNumber(options.rpe_distance_m) + " m";
	std::vector<Table::Column> columns = {{"estimate", "", true},
	                                      {"length", "m"},
	                                      {"poses", ""},
	                                      {"coverage", "%"},
	                                      {"ATE xy", "m"},
	                                      {"ATE z", "m"},
	                                      {"ATE xyz", "m"},
	                                      {"ATE", "% of length"},
	                                      {"yaw", "deg"},
	                                      {"RPE " + interval, "m"},
	                                      {"RPE " + interval, "deg"},
	                                      {"RPE " + distance, "%"},
	                                      {"RPE " + distance, "deg/m"}};
	const bool with_scale = options.alignment == AlignmentKind::sim3;
	const bool with_nees = std::any_of(reports.begin(), reports.end(), [](const EstimateReport& r) { return r.consistency.has_value(); });
	if (with_scale) columns.push_back({"scale", ""});
	if (with_nees) columns.insert(columns.end(), {{"ANEES pos", "per dof"}, {"ANEES yaw", "per dof"}, {"ANEES both", "per dof"}});

	Table table(columns);
	for (const EstimateReport& report : reports)
	{
		const TrajectoryErrors& e = report.errors;
		std::vector<std::string> row = {report.name,
		                                fixed(e.length_m, 2),
		                                std::to_string(e.matched),
		                                fixed(100 * e.coverage, 1),
		                                fixed(e.ate_xy_m, 4),
		                                fixed(e.ate_z_m, 4),
		                                fixed(e.ate_xyz_m, 4),
		                                e.length_m > 0 ? fixed(100 * e.ate_xyz_m / e.length_m, 2) : "-",
		                                fixed(e.yaw_rmse_deg, 3),
		                                fixed(e.rpe_interval_trans_m, 4),
		                                fixed(e.rpe_interval_rot_deg, 3),
		                                fixed(e.rpe_trans_percent, 2),
		                                fixed(e.rpe_rot_deg_per_m, 3)};
		if (with_scale) row.push_back(fixed(e.alignment.scale, 5));
		if (with_nees && report.consistency)
			for (const Nees* nees : {&report.consistency->position, &report.consistency->yaw, &report.consistency->pose})
				row.push_back(fixed(nees->average(), 2));
		row.resize(columns.size(), "-");
		table.addRow(std::move(row));
	}
	return table.toText();
}
}  // namespace viwo
