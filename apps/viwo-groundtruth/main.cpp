#include <viwo/app/Program.h>
#include <viwo/groundtruth/GroundTruthRun.h>

#include <cstdio>

using namespace viwo;

namespace
{
void declare(CLI::App& cli, gt::GroundTruthRunOptions& a, bool& no_odometry_edges)
{
	cli.add_option("-i,--input", a.rawlogs,
	               "Rawlog with scans, and odometry if there is any; several are one session, in the order of time")
	    ->type_name("FILE.rawlog")
	    ->required();
	cli.add_option("-o,--output", a.output_dir, "Folder for what is computed")->type_name("DIR")->required();
	cli.add_option("-c,--config", a.config_path, "Configuration (INI); without it the defaults")->type_name("FILE.ini");
	cli.add_option("--scan-label", a.scan_label, "Sensor label of the scans; not needed where there is only one");
	cli.add_option("--odometry-label", a.odometry_label, "Sensor label of the wheel odometry; without it ODOMETRY, if there is any")
	    ->check(app::notEmpty());
	cli.add_option("--imu-label", a.imu_label, "Sensor label of the IMU; without it IMU, if there is any")->check(app::notEmpty());
	cli.add_option("--resolution", a.resolution_m, "Cell size of the map, m")
	    ->check(app::positive())
	    ->check(CLI::Range(0.005, 1.0))
	    ->capture_default_str();
	cli.add_option("--threads", a.threads, "Threads; the result does not depend on them")->check(CLI::Range(1, 256))->capture_default_str();
	cli.add_flag("--holdout", a.holdout, "Leave every tenth scan out of graph and map, and compare its pose with its match to the map");
	cli.add_flag("--align-axes", a.align_axes, "Turn the map so that most walls lie along its axes");
	cli.add_flag("--no-odometry-edges", no_odometry_edges, "A graph of scans alone; the summary compares it with the usual one");
	cli.add_flag("--allow-truncated", a.allow_truncated, "Take a truncated rawlog as far as it goes");
	cli.footer(
	    "Writes trajectory.tum (O at every scan), trajectory_covariance.csv, graph.g2o, graph_stamps.csv, map.yaml, map.pgm, map.png,\n"
	    "map.simplemap, map.gridmap.gz, summary.json, config.ini.\n"
	    "Examples:\n"
	    "  viwo-groundtruth -i run.rawlog -o truth\n"
	    "  viwo-groundtruth -i run.rawlog -o truth --holdout --threads 2 --align-axes\n"
	    "  viwo-import carmen intel.clf.bz2 -o intel.rawlog && viwo-groundtruth -i intel.rawlog -o intel\n"
	    "Exit status: 0 done, 1 failed, 2 bad usage.");
}

void print(const gt::GroundTruthRunOptions& options, const gt::GroundTruthRunResult& r)
{
	std::printf("%s: %zu scans (%zu key scans), %.1f m; %zu good, %zu degenerate, %zu odometry only; %zu loops; %.1f s of CPU\n",
	            options.output_dir.c_str(), r.scans, r.key_scans, r.path_length_m, r.good, r.degenerate, r.odometry_only, r.loops_accepted,
	            r.cpu_time_s);
	std::fflush(stdout);
	app::tellNotes(r.notes);
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli("Ground truth from a planar lidar: rawlogs in, trajectory, map and their quality out.", "viwo-groundtruth");
	gt::GroundTruthRunOptions options;
	bool no_odometry_edges = false;
	declare(cli, options, no_odometry_edges);
	return app::run(cli, argc, argv,
	                [&]
	                {
		                if (!options.config_path.empty()) loadOptions(options.config_path, options.options.sections());
		                if (no_odometry_edges) options.options.graph.odometry_edges = false;
		                app::ProgressBar bar;
		                gt::GroundTruthRunHooks hooks;
		                hooks.progress = [&](double fraction, const std::string& note) { bar.update(fraction, note); };
		                hooks.interrupted = [] { return app::interrupted(); };
		                const gt::GroundTruthRunResult result = gt::runGroundTruth(options, hooks);
		                bar.clear();
		                print(options, result);
		                return 0;
	                });
}
