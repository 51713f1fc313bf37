#include <viwo/app/Program.h>
#include <viwo/calibration/CalibrationReport.h>
#include <viwo/core/AtomicFile.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "Command.h"

namespace viwo::calibrate
{
namespace
{
struct Arguments
{
	CalibrationRunOptions run;
	std::string config, start, output, html, cam_label, imu_label, odometry_label;
	bool json = false;
};

void declare(CLI::App& command, Arguments& a)
{
	command
	    .add_option("-i,--input", a.run.rawlogs, "Rawlog with images, IMU and wheel odometry, a file, not a pipe; several are one drive")
	    ->type_name("FILE.rawlog")
	    ->required()
	    ->check(app::notEmpty());
	command.add_option("-t,--reference", a.run.reference, "Trajectory of the robot (TUM), e.g. of viwo-groundtruth: tells the scale best")
	    ->type_name("FILE.tum")
	    ->check(app::notEmpty());
	command.add_option("-c,--config", a.config, "Configuration of viwo-odometry (INI), and section [calibration]")
	    ->type_name("FILE.ini")
	    ->check(app::notEmpty());
	command.add_option("--rig", a.start, "Start from this rig.ini instead of what the rawlog says")
	    ->type_name("FILE.ini")
	    ->check(app::notEmpty());
	command.add_option("--from", a.run.from_s, "Start here, s from the first stamp of the labels in use")->check(app::nonNegative());
	command.add_option("--to", a.run.to_s, "Stop here, s from the same stamp")->check(app::nonNegative());
	const auto label = [&](const char* name, std::string& value, const char* of)
	{ command.add_option(name, value, std::string("Label of the ") + of + ", before that of the configuration")->check(app::notEmpty()); };
	label("--cam-label", a.cam_label, "images");
	label("--imu-label", a.imu_label, "IMU");
	label("--odometry-label", a.odometry_label, "wheel odometry");
	command.add_option("-o,--output", a.output, "The rig.ini")->type_name("FILE.ini")->required()->check(app::notEmpty());
	command.add_option("--html", a.html, "Report with residuals before and after")->type_name("FILE.html")->check(app::notEmpty());
	command.add_flag("--json", a.json, "Results as JSON on standard output");
}

void requireFile(const std::string& rawlog)
{
	std::error_code ignored;
	if (rawlog == "-" || std::filesystem::is_fifo(rawlog, ignored) || std::filesystem::is_character_file(rawlog, ignored))
		throw app::UsageError(rawlog + ": estimate reads a rawlog more than once, which a pipe does not allow; give a file");
}

void setLabels(const Arguments& a, AdapterOptions& labels)
{
	if (!a.cam_label.empty()) labels.cam_label = a.cam_label;
	if (!a.imu_label.empty()) labels.imu_label = a.imu_label;
	if (!a.odometry_label.empty()) labels.odometry_label = a.odometry_label;
}

/** Results first: a full disk does not take them along. */
void tell(const Arguments& a, const CalibrationRunResult& result)
{
	std::cout << (a.json ? calibrationJson(result) : calibrationText(result)) << std::flush;
	saveCalibration(result, a.output);
	if (!a.html.empty()) writeAtomically(a.html, calibrationHtml(result));
	app::tellNotes(result.batch.notes);
	if (a.json) return;
	std::cout << "\n" << a.output << std::endl;
	if (!a.html.empty()) std::cout << a.html << std::endl;
}

int estimate(Arguments& a)
{
	if (a.run.to_s <= a.run.from_s) throw app::UsageError("--to must be later than --from");
	for (const std::string& rawlog : a.run.rawlogs) requireFile(rawlog);
	if (!a.config.empty()) loadOptions(a.config, a.run.sections());
	setLabels(a, a.run.odometry.rawlog);
	if (!a.start.empty())
	{
		a.run.start = std::make_shared<RigFile>(RigFile::load(a.start));
		a.run.odometry.use(*a.run.start);
	}
	app::ProgressBar bar;
	CalibrationRunHooks hooks;
	hooks.progress = [&](double fraction, const std::string& note) { bar.update(fraction, note); };
	hooks.interrupted = [] { return app::interrupted(); };
	const CalibrationRunResult result = runCalibration(a.run, hooks);
	bar.clear();
	tell(a, result);
	return 0;
}
}  // namespace

Command addEstimate(CLI::App& cli)
{
	const auto arguments = std::make_shared<Arguments>();
	CLI::App* const command = cli.add_subcommand("estimate", "Mountings, wheels and clocks of a robot from a rawlog of a drive");
	declare(*command, *arguments);
	command->footer(
	    "Examples:\n"
	    "  viwo-calibrate estimate -i calibration.rawlog -o rig.ini --html report.html\n"
	    "  viwo-calibrate estimate -i calibration.rawlog -t lidar.tum --rig measured.ini -o rig.ini\n"
	    "How to drive, and what a drive cannot tell: doc/apps/viwo-calibrate.md.");
	return {command, [arguments] { return estimate(*arguments); }};
}
}  // namespace viwo::calibrate
