#include <viwo/experiments/Runner.h>

#include <mrpt/config/CConfigFileMemory.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/SharedFiles.h>
#include <viwo/odometry/OdometryOptions.h>

#include <algorithm>
#include <filesystem>

#include "TextFiles.h"

namespace viwo::experiments
{
namespace
{
namespace fs = std::filesystem;

const std::string kConfigFolder = "config_files/viwo-odometry/";
const std::string kTruthConfig = "config_files/viwo-groundtruth/lms100.ini";
/** Seconds of computing of viwo-groundtruth for a log. */
constexpr double kTruthCost_s = 10;

void overrule(OdometryOptions& options, const std::string& word)
{
	const size_t dot = word.find('.'), equals = word.find('=');
	const std::string section = word.substr(0, dot);
	for (const OptionsSection& s : options.sections())
	{
		if (s.name != section) continue;
		mrpt::config::CConfigFileMemory memory;
		memory.write(section, word.substr(dot + 1, equals - dot - 1), word.substr(equals + 1));
		s.options->loadFromConfigFile(memory, section);
		return;
	}
	throw Error(word + ": there is no section " + section);
}

/** The configuration with what the run overrules. */
void writeConfig(const RunRecipe& recipe, const std::string& path)
{
	OdometryOptions options;
	if (!recipe.config.empty()) options.load(findShare(kConfigFolder + recipe.config));
	for (const std::string& word : recipe.overrides) overrule(options, word);
	saveOptions(path, options.sections());
}
/** How a run ended that did its work and found no pose: the status of its estimator. Empty for any other. */
std::string statusWithoutPose(const std::string& folder)
{
	if (!fs::exists(folder + "/summary.json")) return {};
	const Json summary = loadJson(folder + "/summary.json");
	const std::string status = summary.value("status", "failed");
	const bool whole = status != "failed" && !summary.value("interrupted", false);
	if (!whole || !summary.at("first_pose_s").is_null()) return {};
	return status + " after " + std::to_string(summary.at("frames").get<int>()) + " frames";
}

/** The trajectory, or the word that there is none. */
bool hasResult(const std::string& folder)
{
	return fs::exists(folder + "/trajectory.tum") || !statusWithoutPose(folder).empty();
}

/** A job that fills a folder, and has nothing to do where that is whole and of the same content.
 *  @param content empty: nothing is kept. @param begun called with the empty folder; may be empty. */
Job folderJob(const std::string& folder, const std::string& content, const std::function<void()>& begun = {})
{
	const std::string inputs = folder + "/inputs.txt";
	Job job;
	if (!content.empty()) job.there = [=] { return holds(inputs, content) && hasResult(folder); };
	job.prepare = [=]
	{
		fs::remove_all(folder);
		fs::create_directories(folder);
		if (begun) begun();
	};
	job.log_stem = folder + "/program";
	if (!content.empty()) job.succeeded = [=] { writeAtomically(inputs, content); };
	return job;
}

std::string contentOf(const LogRecipe& log)
{
	return "---- log\n" + log.program + "\n" + log.content;
}
}  // namespace

Json Outcome::summary() const
{
	return loadJson(file("summary.json"));
}
Trajectory Outcome::trajectory() const
{
	return Trajectory::loadTum(file("trajectory.tum"));
}
Trajectory Outcome::truth() const
{
	return Trajectory::loadTum(ground_truth);
}
TrajectoryErrors Outcome::errors() const
{
	return evaluate(truth(), trajectory(), EvaluationOptions());
}

Runner::Runner(std::string folder, std::string programs)
    : folder_(std::move(folder)), programs_(std::move(programs)), cache_(folder_ + "/cache", programs_)
{
}

size_t Runner::logJob(const LogRecipe& recipe)
{
	const std::string path = cache_.rawlog(recipe);
	if (const auto known = logs_.find(path); known != logs_.end()) return known->second;
	Job job = cache_.job(recipe);
	for (const auto& needed : {recipe.same_images, recipe.made_of})
		if (needed) job.after.push_back(logJob(*needed));
	return logs_[path] = pool_.add(std::move(job));
}

void Runner::want(const RunRecipe& recipe)
{
	if (runs_.count(recipe.name()) != 0) return;
	runs_[recipe.name()] = pool_.add(runJob(recipe, logJob(recipe.log)));
}

std::string Runner::contentOf(const RunRecipe& recipe) const
{
	std::string text = "program " + program_ + "\nmode " + recipe.mode + "\nfrom " + std::to_string(recipe.from_s) + " to " +
	                   std::to_string(recipe.to_s) + "\nconfiguration " + recipe.config + "\n";
	if (!recipe.config.empty()) text += readFile(findShare(kConfigFolder + recipe.config));
	for (const std::string& word : recipe.overrides) text += word + "\n";
	if (!recipe.rig.empty()) text += "---- rig\n" + readFile(recipe.rig);
	return text + experiments::contentOf(recipe.log);
}

Job Runner::runJob(const RunRecipe& recipe, size_t log_job) const
{
	const std::string folder = folderOf(recipe), config = folder + "/given.ini";
	const bool needs_config = !recipe.config.empty() || !recipe.overrides.empty();
	const auto begun = [=]
	{
		if (needs_config) writeConfig(recipe, config);
	};
	Job job = folderJob(folder, program_.empty() ? "" : contentOf(recipe), begun);
	job.label = "run " + recipe.name();
	job.after = {log_job};
	job.command = {programs_ + "/viwo-odometry", "-i", cache_.rawlog(recipe.log), "-o", folder, "--mode", recipe.mode};
	if (needs_config) job.command.insert(job.command.end(), {"-c", config});
	if (!recipe.rig.empty()) job.command.insert(job.command.end(), {"--rig", recipe.rig});
	if (recipe.from_s > 0) job.command.insert(job.command.end(), {"--from", std::to_string(recipe.from_s)});
	if (recipe.to_s > 0) job.command.insert(job.command.end(), {"--to", std::to_string(recipe.to_s)});
	job.tolerated = [=] { return !statusWithoutPose(folder).empty(); };
	job.alone = recipe.alone || recipe.loaded;
	job.loaded = recipe.loaded;
	job.cost_s = recipe.cost_s;
	return job;
}

void Runner::wantTruth(const LogRecipe& log)
{
	if (truths_.count(log.name) != 0) return;
	const std::string folder = truthFolderOf(log), config = findShare(kTruthConfig);
	const std::string content = "program " + truth_program_ + "\n---- configuration\n" + readFile(config) + experiments::contentOf(log);
	Job job = folderJob(folder, truth_program_.empty() ? "" : content);
	job.label = "ground truth of " + log.name;
	job.after = {logJob(log)};
	job.command = {programs_ + "/viwo-groundtruth", "-i", cache_.rawlog(log), "-o", folder, "-c", config};
	job.cost_s = kTruthCost_s;
	truths_[log.name] = pool_.add(std::move(job));
}

Outcome Runner::truthOutcome(const LogRecipe& log) const
{
	return outcomeOf(truths_.at(log.name), truthFolderOf(log), log);
}

void Runner::wantCalibration(const CalibrationRecipe& recipe)
{
	if (calibrations_.count(recipe.log.name) != 0) return;
	const std::string folder = calibrationFolderOf(recipe.log);
	Job job = folderJob(folder, "");
	job.label = "calibration from " + recipe.log.name;
	job.after = {logJob(recipe.log)};
	job.command = {programs_ + "/viwo-calibrate", "estimate", "-i", cache_.rawlog(recipe.log), "--rig", recipe.start};
	job.command.insert(job.command.end(), {"-o", folder + "/rig.ini", "--html", folder + "/report.html", "--json"});
	job.cost_s = recipe.cost_s;
	calibrations_[recipe.log.name] = pool_.add(std::move(job));
}

Outcome Runner::calibrationOutcome(const LogRecipe& log) const
{
	return outcomeOf(calibrations_.at(log.name), calibrationFolderOf(log), log);
}

bool Runner::execute(size_t parallel, const JobHooks& hooks)
{
	return pool_.run(parallel, hooks);
}

Outcome Runner::outcomeOf(size_t job, const std::string& folder, const LogRecipe& log) const
{
	Outcome outcome{pool_.error(job), folder, cache_.groundTruth(log)};
	outcome.open = pool_.open(job);
	if (outcome.open) outcome.error = "not measured yet";
	return outcome;
}

Outcome Runner::outcome(const RunRecipe& recipe) const
{
	Outcome outcome = outcomeOf(runs_.at(recipe.name()), folderOf(recipe), recipe.log);
	if (outcome.failed()) return outcome;
	try
	{
		const std::string status = statusWithoutPose(outcome.folder);
		outcome.no_pose = !status.empty();
		if (outcome.no_pose) outcome.error = "no pose: the estimator is still " + status;
	}
	catch (const std::exception& e)
	{
		outcome.error = e.what();
	}
	return outcome;
}
}  // namespace viwo::experiments
