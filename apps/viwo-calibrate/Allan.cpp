#include <viwo/app/Program.h>
#include <viwo/calibration/ImuNoiseReport.h>

#include <algorithm>
#include <iostream>
#include <memory>

#include "Command.h"

namespace viwo::calibrate
{
namespace
{
struct AllanArguments
{
	ImuNoiseOptions noise;
	std::string rig, output, svg, html, json, csv;
};

RigFile loadRig(const AllanArguments& a)
{
	if (a.rig.empty()) return {};
	RigFile rig = RigFile::load(a.rig);
	if (rig.imu && rig.imu->mounting.label != a.noise.imu_label)
		throw Error(a.rig + ": [IMU] sensorLabel: is " + rig.imu->mounting.label + ", but the noise is that of " + a.noise.imu_label +
		            "; give the rig of the same IMU, or --imu-label");
	return rig;
}

void writeRig(const AllanArguments& a, RigFile rig, const ImuNoiseResult& result)
{
	if (!rig.imu) rig.imu = result.rig();
	result.put(*rig.imu);
	rig.save(a.output, imuNoiseOrigin(result, "viwo-calibrate " + app::version()));
}

int allan(AllanArguments& a)
{
	if (a.noise.to_s <= a.noise.from_s) throw app::UsageError("--to must be later than --from");
	std::replace(a.noise.rawlogs.begin(), a.noise.rawlogs.end(), std::string("-"), std::string("/dev/stdin"));
	const RigFile rig = loadRig(a);  // its errors before the long part
	app::ProgressBar bar;
	ImuNoiseHooks hooks;
	hooks.progress = [&bar](double fraction, const std::string& note) { bar.update(fraction, note); };
	hooks.interrupted = [] { return app::interrupted(); };
	const ImuNoiseResult result = estimateImuNoise(a.noise, hooks);
	bar.clear();
	std::cout << describeImuNoise(result) << std::flush;
	app::tellNotes(result.warnings);
	writeRig(a, rig, result);
	if (!a.svg.empty()) saveImuNoiseSvg(a.svg, result);
	if (!a.html.empty()) saveImuNoiseHtml(a.html, result);
	if (!a.json.empty()) saveImuNoiseJson(a.json, result);
	if (!a.csv.empty()) saveImuNoiseCsv(a.csv, result);
	for (const std::string& path : {a.output, a.svg, a.html, a.json, a.csv})
		if (!path.empty()) std::cout << path << std::endl;
	return 0;
}
}  // namespace

Command addAllan(CLI::App& cli)
{
	auto a = std::make_shared<AllanArguments>();
	CLI::App* command = cli.add_subcommand("allan", "Noise of an IMU from a log at rest, by its Allan deviation, as a rig.ini");
	command->add_option("-i,--input", a->noise.rawlogs, "Rawlogs of the IMU standing still for hours; - is standard input")
	    ->type_name("FILE.rawlog")
	    ->required()
	    ->check(app::notEmpty());
	command->add_option("--imu-label", a->noise.imu_label, "Label of the IMU in the rawlogs")
	    ->capture_default_str()
	    ->check(app::notEmpty());
	command->add_option("--from", a->noise.from_s, "Start here, s from the IMU's first stamp")->check(app::nonNegative());
	command->add_option("--to", a->noise.to_s, "Stop here, s from the IMU's first stamp")->check(app::nonNegative());
	command->add_option("--rig", a->rig, "A rig.ini of which all else is kept")->type_name("FILE.ini")->check(app::notEmpty());
	command->add_option("-o,--output", a->output, "The rig.ini with the noise")->type_name("FILE.ini")->required()->check(app::notEmpty());
	command->add_option("--svg", a->svg, "The plot")->type_name("FILE.svg")->check(app::notEmpty());
	command->add_option("--html", a->html, "Plot and tables on one page")->type_name("FILE.html")->check(app::notEmpty());
	command->add_option("--json", a->json, "All figures with their deviations")->type_name("FILE.json")->check(app::notEmpty());
	command->add_option("--csv", a->csv, "The curves")->type_name("FILE.csv")->check(app::notEmpty());
	return {command, [a] { return allan(*a); }};
}
}  // namespace viwo::calibrate
