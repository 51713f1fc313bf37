#include <viwo/app/Program.h>
#include <viwo/core/PeakMemory.h>
#include <viwo/mapping/OctoMapRun.h>
#include <viwo/mapping/OctreeFiles.h>
#include <viwo/mapping/PoseFlags.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

using namespace viwo;

namespace
{
struct Arguments
{
	OctoMapRunOptions run;
	std::vector<std::string> sources;
	std::string colour = "none";
	bool filter_ground = false;
	GroundFilter ground;
};

void declareOutputs(CLI::App& cli, Arguments& a)
{
	cli.add_option("-i,--input", a.run.rawlog, "Rawlog")->type_name("FILE.rawlog")->required()->check(app::notEmpty());
	cli.add_option("-t,--trajectory", a.run.trajectory, "Trajectory of the vehicle (TUM)")
	    ->type_name("FILE.tum")
	    ->required()
	    ->check(app::notEmpty());
	cli.add_option("-o,--output", a.run.output, "OctoMap: .bt (free, occupied, unknown) or .ot (log-odds, colours)")
	    ->type_name("FILE.bt|.ot")
	    ->required()
	    ->check(app::notEmpty());
	cli.add_flag("--both", a.run.both, "Write both .bt and .ot");
	cli.add_option("--scan-graph", a.run.scan_graph, "Write the scans as text for octomap's log2graph, too (.log)")->type_name("FILE.log");
	cli.add_option("--to-ply", a.run.ply, "Write the centres of the occupied voxels, too")->type_name("FILE.ply");
	CLI::Option* grid =
	    cli.add_option("--to-grid", a.run.grid, "Write the map seen from above for ROS's map_server, too (.yaml, with .pgm beside it)")
	        ->type_name("FILE.yaml");
	cli.add_option("--grid-min-z", a.run.grid_slice.min_z_m, "From this height on, m (0.05; of a flat map its lowest)")
	    ->check(app::finite());
	cli.add_option("--grid-max-z", a.run.grid_slice.max_z_m, "Up to this height, m (2; of a flat map its highest)")
	    ->needs(grid)
	    ->check(app::finite());
	cli.add_option("--colour", a.colour, "ColorOcTree: colours of the sensor's returns, or by height (.ot only)")
	    ->check(CLI::IsMember({"none", "sensor", "height"}))
	    ->capture_default_str();
}

void declareSources(CLI::App& cli, Arguments& a)
{
	RayOptions& rays = a.run.rays;
	cli.add_option("--sources", a.sources, "Which of scans, depth, clouds, landmarks; without it all there are")
	    ->delimiter(',')
	    ->check(CLI::IsMember({"scans", "depth", "clouds", "landmarks"}));
	CLI::Option* landmarks =
	    cli.add_option("--landmarks", a.run.landmarks_dir, "Output folder of viwo-odometry: its landmarks go in as well")->type_name("DIR");
	cli.add_option("--max-landmark-deviation", a.run.max_landmark_deviation,
	               "Landmarks with a larger relative deviation of depth are left out")
	    ->needs(landmarks)
	    ->check(app::positive())
	    ->capture_default_str();
	CLI::Option* flags =
	    cli.add_option("--flags", a.run.flags, "trajectory_covariance.csv: observations whose pose is flagged as bad are left out")
	        ->type_name("FILE.csv");
	cli.add_option("--bad-flags", a.run.bad_flags, "Flags that count as bad")
	    ->delimiter(',')
	    ->needs(flags)
	    ->check(CLI::IsMember(knownPoseFlags()))
	    ->capture_default_str();
	cli.add_option("--max-gap", rays.max_gap_s, "Longest gap of the trajectory to interpolate across, s")
	    ->check(app::positive())
	    ->capture_default_str();
	CLI::Option* duration =
	    cli.add_option("--scan-duration", rays.scan_duration_s, "Planar scans: from the first to the last beam, s; 0: all at once")
	        ->check(app::between(0, 10))
	        ->capture_default_str();
	cli.add_option("--stamp-position", rays.stamp_position, "Planar scans: where in the sweep the stamp lies, 0 first beam, 1 last")
	    ->needs(duration)
	    ->check(app::between(0, 1))
	    ->capture_default_str();
}

void declareFilters(CLI::App& cli, Arguments& a)
{
	RayOptions& rays = a.run.rays;
	cli.add_option("--min-range", rays.min_range_m, "Nearer returns are left out, m")->check(app::nonNegative())->capture_default_str();
	cli.add_option("--subsample", rays.subsample, "Every n-th return of an observation")
	    ->check(CLI::Range(1, 1000000))
	    ->capture_default_str();
	cli.add_option("--pointcloud-min-z", rays.min_z_m, "Returns below this height in the map are left out, m")->check(app::finite());
	cli.add_option("--pointcloud-max-z", rays.max_z_m, "Returns above this height in the map are left out, m")->check(app::finite());
	CLI::Option* filter = cli.add_flag("--filter-ground", a.filter_ground, "Depth images and clouds: the ground is not occupied");
	const auto ofGround = [&](const char* name, double& value, const char* meaning)
	{ cli.add_option(name, value, meaning)->needs(filter)->check(app::positive())->capture_default_str(); };
	ofGround("--ground-distance", a.ground.distance_m, "Points this near to the ground's plane belong to it, m");
	ofGround("--ground-angle", a.ground.angle_rad, "Largest slope of that plane, rad");
	ofGround("--ground-plane-distance", a.ground.plane_distance_m, "Largest distance of that plane from the vehicle's origin, m");
	cli.add_flag("--allow-truncated", a.run.allow_truncated, "Take a truncated rawlog as far as it goes");
}

CLI::Validator rangeLimit()
{
	const auto check = [](std::string& text)
	{ return text == "-1" || app::positive()(text).empty() ? std::string() : "'" + text + "' is neither a finite number above 0 nor -1"; };
	return CLI::Validator(check, "");
}

void declareModel(CLI::App& cli, Arguments& a)
{
	cli.add_option("--resolution", a.run.resolution_m, "Edge of a voxel, m")->check(app::between(0.001, 1000))->capture_default_str();
	cli.add_option("--max-range", a.run.casting.max_range_m, "Longer rays only clear, up to this, m; -1: no limit")
	    ->check(rangeLimit())
	    ->capture_default_str();
	cli.add_flag("--discretize", a.run.casting.discretize, "One ray for each voxel hit in an observation");
	cli.add_option("--hit", a.run.model.hit, "Sensor model: probability of a hit")->check(app::inside(0.5, 1))->capture_default_str();
	cli.add_option("--miss", a.run.model.miss, "Sensor model: probability of a miss")->check(app::inside(0, 0.5))->capture_default_str();
	cli.add_option("--min", a.run.model.clamping_min, "Sensor model: clamping limit of free voxels")
	    ->check(app::inside(0, 0.5))
	    ->capture_default_str();
	cli.add_option("--max", a.run.model.clamping_max, "Sensor model: clamping limit of occupied voxels")
	    ->check(app::inside(0.5, 1))
	    ->capture_default_str();
	cli.add_option("--occupancy-thres", a.run.model.occupancy_threshold, "Probability from which on a voxel is occupied")
	    ->check(app::inside(0, 1))
	    ->capture_default_str();
	cli.add_option("--threads", a.run.threads, "Threads; the result does not depend on them")
	    ->check(CLI::Range(1, 256))
	    ->default_str("number of processors, at most 16");
	cli.footer(
	    "Examples:\n"
	    "  viwo-octomap -i run.rawlog -t truth/trajectory.tum -o run.bt --flags truth/trajectory_covariance.csv\n"
	    "  viwo-octomap -i run.rawlog -t out/trajectory.tum -o run.ot --landmarks out --colour height --to-ply run.ply\n"
	    "  viwo-octomap -i run.rawlog -t out/trajectory.tum -o run.bt --sources depth --discretize --max-range 4 --to-grid run.yaml\n"
	    "Exit status: 0 done, 1 failed, 2 bad usage.");
}

std::string withExtension(const std::string& path, const char* extension)
{
	return std::filesystem::path(path).replace_extension(extension).string();
}

/** What --both writes beside the output. */
std::string otherOctree(const std::string& path)
{
	return withExtension(path, octreeFormatOf(path) == OctreeFormat::bt ? ".ot" : ".bt");
}

void requireRisingLimits(const OctoMapRunOptions& run)
{
	const HeightSlice& grid = run.grid_slice;
	if (grid.min_z_m.value_or(HeightSlice::kMin_z_m) > grid.max_z_m.value_or(HeightSlice::kMax_z_m))
		throw app::UsageError("--grid-max-z (2 unless given) is below --grid-min-z (0.05 unless given)");
	if (run.rays.min_z_m > run.rays.max_z_m) throw app::UsageError("--pointcloud-max-z is below --pointcloud-min-z");
	if (run.casting.max_range_m > 0 && run.rays.min_range_m >= run.casting.max_range_m)
		throw app::UsageError("--max-range is not above --min-range: every return would be left out");
	const SensorModel& model = run.model;
	if (model.occupancy_threshold <= model.clamping_min || model.occupancy_threshold >= model.clamping_max)
		throw app::UsageError("--occupancy-thres must lie between --min and --max, or all voxels are the same");
}

std::vector<std::string> inputsOf(const OctoMapRunOptions& run)
{
	std::vector<std::string> inputs{run.rawlog, run.trajectory, run.flags};
	if (!run.landmarks_dir.empty())
		for (const char* name : {"landmarks.ply", "landmark_observations.csv", "keyframes.csv", "trajectory.tum"})
			inputs.push_back((std::filesystem::path(run.landmarks_dir) / name).string());
	return inputs;
}

std::vector<std::string> outputsOf(const OctoMapRunOptions& run)
{
	std::vector<std::string> outputs{run.output};
	if (run.both) outputs.push_back(otherOctree(run.output));
	if (!run.grid.empty()) outputs.insert(outputs.end(), {run.grid, withExtension(run.grid, ".pgm")});
	for (const std::string& name : {run.ply, run.scan_graph})
		if (!name.empty()) outputs.push_back(name);
	return outputs;
}

void interpret(Arguments& a)
{
	OctoMapRunOptions& run = a.run;
	try
	{
		octreeFormatOf(run.output);
	}
	catch (const Error& e)
	{
		throw app::UsageError(e.what());
	}
	requireRisingLimits(run);
	if (!run.grid.empty() && std::filesystem::path(run.grid).extension() != ".yaml")
		throw app::UsageError(run.grid + ": a grid map's name ends in .yaml");
	app::requireInputsAreKept(inputsOf(run), outputsOf(run));
	const auto asked = [&](const char* source) { return a.sources.empty() || std::count(a.sources.begin(), a.sources.end(), source) > 0; };
	run.rays.scans = asked("scans");
	run.rays.depth = asked("depth");
	run.rays.clouds = asked("clouds");
	if (!asked("landmarks") && !run.landmarks_dir.empty())
		throw app::UsageError("--landmarks is given, but landmarks are not among --sources");
	if (!a.sources.empty() && asked("landmarks") && run.landmarks_dir.empty())
		throw app::UsageError("--sources landmarks needs --landmarks DIR, the output folder of viwo-odometry");
	if (a.filter_ground) run.rays.ground = a.ground;
	run.colours = a.colour == "none" ? VoxelColours::none : a.colour == "sensor" ? VoxelColours::sensor : VoxelColours::height;
}

void print(const Arguments& a, const OctoMapRunResult& r)
{
	if (a.run.both) std::printf("%s and ", otherOctree(a.run.output).c_str());
	std::printf("%s: %zu observations, %zu rays; %zu occupied and %zu free leaves; %.1f s, %.0f MiB\n", a.run.output.c_str(), r.used,
	            r.rays, r.occupied, r.free, r.wall_time_s, peakMemory_mb());
	std::fflush(stdout);
	std::vector<std::string> notes;
	const auto note = [&notes](size_t count, const char* what)
	{
		if (count > 0) notes.push_back(std::to_string(count) + " " + what);
	};
	note(r.flagged, "observations left out: their poses are flagged as bad");
	note(r.no_pose, "observations left out: no pose at their time");
	note(r.no_time, "observations left out: they have no stamp, or one that does not fit the others");
	note(r.empty, "observations have no return");
	note(r.scans_off_grid, "planar scans lie outside of the grid's heights; set --grid-min-z and --grid-max-z to see them there");
	note(r.unusable_rays, "rays left out: beyond the octree or not finite");
	app::tellNotes(notes);
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli("OctoMap out of a rawlog and a trajectory: scans, depth images, point clouds, landmarks.", "viwo-octomap");
	Arguments arguments;
	arguments.run.threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
	declareOutputs(cli, arguments);
	declareSources(cli, arguments);
	declareFilters(cli, arguments);
	declareModel(cli, arguments);
	return app::run(cli, argc, argv,
	                [&]
	                {
		                interpret(arguments);
		                app::ProgressBar bar;
		                OctoMapRunHooks hooks;
		                hooks.progress = [&](double fraction, const std::string& note) { bar.update(fraction, note); };
		                hooks.interrupted = [] { return app::interrupted(); };
		                const OctoMapRunResult result = runOctoMap(arguments.run, hooks);
		                bar.clear();
		                print(arguments, result);
		                return 0;
	                });
}
