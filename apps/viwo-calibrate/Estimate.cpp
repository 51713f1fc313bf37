#include <viwo/app/Program.h>
#include <viwo/calibration/CalibrationReport.h>
#include <viwo/core/AtomicFile.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "Command.h"

namespace viwo::calibrate
{
namespace
{
struct Arguments
{
	CalibrationRunOptions run;
	std::string config, start, output, html;
	bool json = false;
};

void declare(CLI::App& command, Arguments& a)
{
	command.add_option("-i,--input", a.run.rawlogs, "Rawlog with images, IMU and wheel odometry; several are one drive")
	    ->required()
	    ->check(app::notEmpty());
	command.add_option("-t,--reference", a.run.reference, "Trajectory of the robot (TUM), e.g. of viwo-groundtruth: tells the scale best")
	    ->check(app::notEmpty());
	command.add_option("-c,--config", a.config, "Configuration of viwo-odometry (INI), and section [calibration]")->check(app::notEmpty());
	command.add_option("--rig", a.start, "Start from this rig.ini instead of what the rawlog says")->check(app::notEmpty());
	command.add_option("-o,--output", a.output, "The rig.ini")->required()->check(app::notEmpty());
	command.add_option("--html", a.html, "Report with residuals before and after")->check(app::notEmpty());
	command.add_flag("--json", a.json, "Results as JSON on standard output");
}

int estimate(Arguments& a)
{
	if (!a.config.empty()) loadOptions(a.config, a.run.sections());
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
	saveCalibration(result, a.output);
	if (!a.html.empty()) writeAtomically(a.html, calibrationHtml(result));
	std::fputs((a.json ? calibrationJson(result) : calibrationText(result)).c_str(), stdout);
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
