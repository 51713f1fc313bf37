#include <viwo/experiments/Accuracy.h>
#include <viwo/experiments/ErrorBudget.h>

#include <cmath>
#include <functional>

#include "Figures.h"

namespace viwo::experiments
{
namespace
{
using Words = std::vector<std::string>;

const std::string kNoError = "0 0 0 0 0 0";

/** The same drive with some sources switched off. Where the camera does not notice, the images are those of another. */
RunRecipe runOf(const std::string& sequence, uint64_t seed, const std::string& what, const Words& off, const Words* images_of)
{
	SimulatedDrive drive = sequenceDrive(sequence);
	if (images_of != nullptr)
	{
		SimulatedDrive same = drive;
		if (!images_of->empty()) same.name += "-no-errors";
		same.overrides = *images_of;
		drive.same_images = std::make_shared<const SimulatedDrive>(same);
	}
	if (!off.empty()) drive.name += "-" + what;
	drive.overrides = off;
	RunRecipe run(drive.log(seed));
	const double duration_s = sequenceDuration_s(sequence);
	run.log.cost_s = (images_of != nullptr ? 0.02 : kRenderingCost) * duration_s;
	run.cost_s = kVisionCost * duration_s;
	return run;
}

Words offBut(const ErrorSource* kept)
{
	Words off;
	for (const ErrorSource& source : errorSources())
		if (&source != kept) off.insert(off.end(), source.off.begin(), source.off.end());
	return off;
}

std::string dashed(std::string name)
{
	for (char& c : name)
		if (c == ' ' || c == ',') c = '-';
	return name;
}

RunRecipe allOf(const std::string& sequence, uint64_t seed)
{
	return runOf(sequence, seed, "", {}, nullptr);
}
RunRecipe noneOf(const std::string& sequence, uint64_t seed)
{
	return runOf(sequence, seed, "no-errors", offBut(nullptr), nullptr);
}
RunRecipe aloneOf(const std::string& sequence, uint64_t seed, const ErrorSource& source)
{
	const Words none = offBut(nullptr);
	return runOf(sequence, seed, "only-" + dashed(source.name), offBut(&source), cameraIsBlindTo(source.off) ? &none : nullptr);
}
RunRecipe withoutOf(const std::string& sequence, uint64_t seed, const ErrorSource& source)
{
	const Words all;
	return runOf(sequence, seed, "without-" + dashed(source.name), source.off, cameraIsBlindTo(source.off) ? &all : nullptr);
}

/** Median over the seeds of the runs that a recipe makes. */
double medianAte(const Runner& runner, const Request& request, const std::function<RunRecipe(uint64_t)>& recipe, Words& problems)
{
	DriveResult result;
	for (const uint64_t seed : request.seeds)
	{
		const RunRecipe run = recipe(seed);
		std::optional<Trajectory> truth;
		result.seeds.push_back(driveErrors(runner.outcome(run), seed, truth));
		if (result.seeds.back().failed) problems.push_back(run.name() + ": " + result.seeds.back().problem);
	}
	return result.median([](const DriveErrors& e) { return e.se3.ate_xyz_m; });
}

std::string centimetres(double ate_m)
{
	return cell(100 * ate_m, 2);
}
}  // namespace

const std::vector<ErrorSource>& errorSources()
{
	static const std::vector<ErrorSource> sources{
	    {"IMU noise and resolution",
	     {"imu.acc_noise_m_s2_sqrtHz=0", "imu.gyro_noise_rad_s_sqrtHz=0", "imu.acc_walk_m_s3_sqrtHz=0", "imu.gyro_walk_rad_s2_sqrtHz=0",
	      "imu.acc_resolution_m_s2=0", "imu.gyro_resolution_rad_s=0"}},
	    {"IMU start biases", {"imu.acc_start_bias_m_s2=0", "imu.gyro_start_bias_rad_s=0"}},
	    {"IMU scales and axes", {"imu.acc_scale_error=0", "imu.gyro_scale_error=0", "imu.axis_misalignment_deg=0"}},
	    {"IMU mounting", {"imu.pose_error=" + kNoError}},
	    {"wheel radii", {"wheels.radius_error=0"}},
	    {"left-right difference", {"wheels.left_right_difference=0"}},
	    {"track", {"wheels.track_error=0"}},
	    {"wheel noise and ticks", {"wheels.noise_m_s_sqrtHz=0", "wheels.noise_per_speed_sqrtHz=0", "wheels.tick_quantisation=false"}},
	    {"slips", {"wheels.slips="}},
	    {"camera mounting", {"camera.pose_error=" + kNoError}},
	    {"image noise, blur and JPEG",
	     {"image_effects.shot_noise=false", "image_effects.read_noise_e=0", "renderer.motion_blur=false", "camera.format=png"}},
	    {"floor and vibration", {"floor.height_rms_mm=0", "vibration.acceleration_m_s2=0", "vibration.rate_deg_s=0"}}};
	return sources;
}

void planErrorBudget(Runner& runner, const Request& request)
{
	for (const std::string& sequence : request.error_budget)
		for (const uint64_t seed : request.seeds)
		{
			runner.want(allOf(sequence, seed));
			runner.want(noneOf(sequence, seed));
			for (const ErrorSource& source : errorSources())
			{
				runner.want(aloneOf(sequence, seed, source));
				runner.want(withoutOf(sequence, seed, source));
			}
		}
}

std::vector<ErrorBudget> errorBudgets(const Runner& runner, const Request& request)
{
	std::vector<ErrorBudget> budgets;
	for (const std::string& sequence : request.error_budget)
	{
		ErrorBudget budget;
		budget.sequence = sequence;
		const auto ate_m = [&](const std::function<RunRecipe(uint64_t)>& recipe)
		{ return medianAte(runner, request, recipe, budget.problems); };
		budget.all_m = ate_m([&](uint64_t seed) { return allOf(sequence, seed); });
		budget.none_m = ate_m([&](uint64_t seed) { return noneOf(sequence, seed); });
		for (const ErrorSource& source : errorSources())
		{
			budget.alone_m.push_back(ate_m([&](uint64_t seed) { return aloneOf(sequence, seed, source); }));
			budget.without_m.push_back(ate_m([&](uint64_t seed) { return withoutOf(sequence, seed, source); }));
		}
		budgets.push_back(std::move(budget));
	}
	return budgets;
}

Table errorBudgetTable(const std::vector<ErrorBudget>& budgets)
{
	std::vector<Table::Column> columns{{"source of error", "", true}};
	for (const ErrorBudget& budget : budgets)
	{
		columns.push_back({budget.sequence + ", alone", "cm"});
		columns.push_back({budget.sequence + ", without it", "cm"});
	}
	Table table(columns);
	std::vector<std::string> whole{"all of them, and none"};
	for (const ErrorBudget& budget : budgets) whole.insert(whole.end(), {centimetres(budget.all_m), centimetres(budget.none_m)});
	table.addRow(whole);
	for (size_t i = 0; i < errorSources().size(); ++i)
	{
		std::vector<std::string> cells{errorSources()[i].name};
		for (const ErrorBudget& budget : budgets)
			cells.insert(cells.end(), {centimetres(budget.alone_m[i]), centimetres(budget.without_m[i])});
		table.addRow(cells);
	}
	return table;
}

Json errorBudgetJson(const std::vector<ErrorBudget>& budgets)
{
	const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
	Json list = Json::array();
	for (const ErrorBudget& budget : budgets)
	{
		Json sources = Json::array();
		for (size_t i = 0; i < errorSources().size(); ++i)
			sources.push_back({{"source", errorSources()[i].name},
			                   {"switched_off_by", errorSources()[i].off},
			                   {"alone_ate_xyz_m", number(budget.alone_m[i])},
			                   {"without_ate_xyz_m", number(budget.without_m[i])}});
		list.push_back({{"sequence", budget.sequence},
		                {"all_ate_xyz_m", number(budget.all_m)},
		                {"none_ate_xyz_m", number(budget.none_m)},
		                {"sources", sources}});
	}
	return list;
}
}  // namespace viwo::experiments
