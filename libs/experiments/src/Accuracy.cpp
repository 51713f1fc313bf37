#include <viwo/core/Error.h>
#include <viwo/experiments/Accuracy.h>

#include <cmath>
#include <set>

#include "Figures.h"

namespace viwo::experiments
{
namespace
{
/** Of ATE in tables, m. */
constexpr int kDecimals = 3;
/** A run that covers less of the drive is a failure, whatever its error. */
constexpr double kRequiredCoverage = 0.9;

RunRecipe runOf(const std::string& sequence, uint64_t seed, const Variant& variant)
{
	RunRecipe run(sequenceLog(sequence, seed));
	run.mode = variant.mode;
	run.overrides = variant.overrides;
	if (!variant.overrides.empty())
		for (const char c : variant.name) run.variant += c == ' ' ? '-' : c;
	run.cost_s = sequenceDuration_s(sequence) * (variant.mode == "wheel" ? kWheelCost : kVisionCost);
	return run;
}

std::vector<Variant> variantsOf(const Request& request)
{
	std::vector<Variant> variants;
	if (request.tables.count(1) != 0) variants = modes();
	if (!request.ablations) return variants;
	if (variants.empty()) variants.push_back(modes().back());
	variants.insert(variants.end(), ablations().begin(), ablations().end());
	return variants;
}

/** @throws Error where nothing can be compared. */
void judge(const Trajectory& truth, DriveErrors& errors)
{
	EvaluationOptions options;
	errors.se3 = evaluate(truth, *errors.estimate, options);
	options.alignment = AlignmentKind::yaw;
	errors.yaw = evaluate(truth, *errors.estimate, options);
	if (errors.se3.coverage < kRequiredCoverage) errors.problem = "covers only " + fixed(100 * errors.se3.coverage, 0) + " % of the drive";
}

double xy(const DriveErrors& e)
{
	return e.se3.ate_xy_m;
}
double z(const DriveErrors& e)
{
	return e.se3.ate_z_m;
}
double xyz(const DriveErrors& e)
{
	return e.se3.ate_xyz_m;
}
double zYaw(const DriveErrors& e)
{
	return e.yaw.ate_z_m;
}

const PaperAte& paperOf(const std::string& sequence, const std::string& mode)
{
	const PaperSequence& paper = paperSequence(sequence);
	return mode == "vio" ? paper.vio : mode == "wheel" ? paper.wheel : paper.viwo;
}

const DriveResult* find(const std::vector<DriveResult>& results, const std::string& sequence, const std::string& variant)
{
	for (const DriveResult& result : results)
		if (result.sequence == sequence && result.variant.name == variant) return &result;
	return nullptr;
}
}  // namespace

const std::vector<Variant>& modes()
{
	static const std::vector<Variant> list{{"vio", "vio", {}}, {"wheel", "wheel", {}}, {"viwo", "viwo", {}}};
	return list;
}

const std::vector<Variant>& ablations()
{
	static const std::vector<Variant> list{{"no wheel factor", "viwo", {"factors.wheel_factor=false"}},
	                                       {"no plane factor", "viwo", {"factors.plane_factor=false"}},
	                                       {"no wheels in the start", "viwo", {"factors.wheels_in_initialization=false"}},
	                                       {"plain mean of gyro biases", "viwo", {"initializer.gyro_bias=paper_mean"}},
	                                       {"no slip gate", "viwo", {"factors.slip_gate=false"}}};
	return list;
}

DriveErrors driveErrors(const Outcome& outcome, uint64_t seed, std::optional<Trajectory>& truth)
{
	DriveErrors errors;
	errors.seed = seed;
	errors.problem = outcome.error;
	errors.open = outcome.open;
	errors.failed = outcome.failed() && !outcome.no_pose && !outcome.open;
	errors.folder = outcome.folder;
	errors.ground_truth = outcome.ground_truth;
	if (outcome.failed()) return errors;
	try
	{
		if (!truth) truth = outcome.truth();
		errors.estimate = std::make_shared<const Trajectory>(outcome.trajectory());
		judge(*truth, errors);
	}
	catch (const Error& e)
	{
		errors.problem = e.what();
		errors.failed = !errors.estimate;  // the files; an estimate that cannot be compared is the estimator's
	}
	return errors;
}

double DriveResult::median(const std::function<double(const DriveErrors&)>& figure) const
{
	std::vector<double> values;
	for (const DriveErrors& e : seeds) values.push_back(e.open ? kOpen : e.problem.empty() ? figure(e) : kFailed);
	return experiments::median(values);
}

void planDrives(Runner& runner, const Request& request)
{
	for (const std::string& sequence : request.sequences)
		for (const uint64_t seed : request.seeds)
			for (const Variant& variant : variantsOf(request)) runner.want(runOf(sequence, seed, variant));
}

std::vector<DriveResult> driveResults(const Runner& runner, const Request& request)
{
	std::vector<DriveResult> results;
	const std::vector<Variant> variants = variantsOf(request);
	for (const std::string& sequence : request.sequences)
	{
		const size_t first = results.size();
		for (const Variant& variant : variants) results.push_back({sequence, variant, {}});
		for (const uint64_t seed : request.seeds)
		{
			std::optional<Trajectory> truth;
			for (size_t i = 0; i < variants.size(); ++i)
				results[first + i].seeds.push_back(driveErrors(runner.outcome(runOf(sequence, seed, variants[i])), seed, truth));
		}
	}
	return results;
}

Table table1(const std::vector<DriveResult>& results)
{
	std::vector<Table::Column> columns{{"sequence", "", true}, {"", "", true}};
	for (const Variant& mode : modes())
		for (const char* axes : {"x-y", "z", "x-y-z"}) columns.push_back({mode.name + " " + axes, "m", false});
	columns.push_back({"viwo z, yaw only", "m"});
	Table table(columns);
	for (const std::string& sequence : sequencesOf(results))
	{
		std::vector<std::string> own{sequence, "ours"}, printed{"", "paper"};
		std::vector<std::vector<double>> by_axes(3);
		for (const Variant& mode : modes())
		{
			const DriveResult& result = *find(results, sequence, mode.name);
			const PaperAte& paper = paperOf(sequence, mode.name);
			size_t axes = 0;
			for (const auto& [figure, paper_m] : {std::pair(xy, paper.xy_m), std::pair(z, paper.z_m), std::pair(xyz, paper.xyz_m)})
			{
				by_axes[axes].push_back(result.median(figure));
				own.push_back(cell(by_axes[axes++].back(), kDecimals));
				printed.push_back(fixed(paper_m, 2));
			}
		}
		std::set<size_t> bold;
		for (size_t axes = 0; axes < by_axes.size(); ++axes)
			for (const size_t mode : smallest(by_axes[axes], kDecimals)) bold.insert(2 + 3 * mode + axes);
		own.push_back(cell(find(results, sequence, "viwo")->median(zYaw), kDecimals));
		printed.emplace_back("-");
		table.addRow(own, bold);
		table.addRow(printed);
	}
	return table;
}

Table table1Runs(const std::vector<DriveResult>& results)
{
	Table table({{"sequence", "", true},
	             {"run", "", true},
	             {"seed", ""},
	             {"x-y", "m"},
	             {"z", "m"},
	             {"x-y-z", "m"},
	             {"z, yaw-aligned", "m"},
	             {"length", "m"},
	             {"of length", "%"},
	             {"remark", "", true}});
	for (const DriveResult& result : results)
		for (const DriveErrors& e : result.seeds)
		{
			std::vector<std::string> cells{result.sequence, result.variant.name, std::to_string(e.seed)};
			const bool fine = e.problem.empty();
			for (const double value : {xy(e), z(e), xyz(e), zYaw(e)}) cells.push_back(fine ? fixed(value, 4) : "-");
			cells.push_back(fine ? fixed(e.se3.length_m, 2) : "-");
			cells.push_back(fine ? fixed(100 * xyz(e) / e.se3.length_m, 3) : "-");
			cells.push_back(e.problem);
			table.addRow(cells);
		}
	return table;
}

Table ablationTable(const std::vector<DriveResult>& results)
{
	std::vector<Table::Column> columns{{"sequence", "", true}, {"viwo", "m"}};
	for (const Variant& variant : ablations()) columns.push_back({variant.name, "m"});
	Table table(columns);
	for (const std::string& sequence : sequencesOf(results))
	{
		std::vector<std::string> cells{sequence};
		std::vector<double> figures;
		for (const Table::Column& column : columns)
			if (const DriveResult* result = find(results, sequence, column.name)) figures.push_back(result->median(xyz));
		if (figures.size() + 1 != columns.size()) continue;
		for (const double figure : figures) cells.push_back(cell(figure, kDecimals));
		std::set<size_t> bold;
		for (const size_t i : smallest(figures, kDecimals)) bold.insert(1 + i);
		table.addRow(cells, bold);
	}
	return table;
}

Json table1Json(const std::vector<DriveResult>& results)
{
	Json rows = Json::array();
	for (const DriveResult& result : results)
	{
		Json row{{"sequence", result.sequence}, {"run", result.variant.name}};
		row["median"] = {{"ate_xy_m", result.median(xy)},
		                 {"ate_z_m", result.median(z)},
		                 {"ate_xyz_m", result.median(xyz)},
		                 {"ate_z_yaw_aligned_m", result.median(zYaw)}};
		if (result.variant.overrides.empty())
		{
			const PaperAte& paper = paperOf(result.sequence, result.variant.name);
			row["paper"] = {{"ate_xy_m", paper.xy_m}, {"ate_z_m", paper.z_m}, {"ate_xyz_m", paper.xyz_m}};
		}
		for (const DriveErrors& e : result.seeds)
		{
			Json seed{{"seed", e.seed}, {"problem", e.problem}};
			if (e.problem.empty())
				seed.update({{"ate_xy_m", xy(e)},
				             {"ate_z_m", z(e)},
				             {"ate_xyz_m", xyz(e)},
				             {"ate_z_yaw_aligned_m", zYaw(e)},
				             {"yaw_rmse_deg", e.se3.yaw_rmse_deg},
				             {"rpe_trans_percent", e.se3.rpe_trans_percent},
				             {"length_m", e.se3.length_m},
				             {"coverage", e.se3.coverage}});
			row["seeds"].push_back(seed);
		}
		rows.push_back(row);
	}
	return rows;
}
}  // namespace viwo::experiments
