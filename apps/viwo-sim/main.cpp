#include <viwo/app/Program.h>
#include <viwo/sim/Sequence.h>
#include <viwo/sim/Simulation.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

using namespace viwo;

namespace
{
struct Arguments
{
	std::string world = "corridor", route = "corridor_out_and_back", rig = "turtlebot2";
	std::string sequence;
	std::string output;
	uint64_t seed = 1;
	bool no_images = false;
	std::string images_from;
	int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
	std::vector<std::string> overrides;
};

void declare(CLI::App& cli, Arguments& a)
{
	CLI::Option* sequence =
	    cli.add_option("--sequence", a.sequence,
	                   "World, route and rig together: an INI file, or the name of one in share/viwo/sequences, e.g. seq01")
	        ->type_name("FILE.ini");
	cli.add_option("-w,--world", a.world, "World: an INI file, or the name of one in share/viwo/worlds")
	    ->type_name("FILE.ini")
	    ->capture_default_str()
	    ->excludes(sequence);
	cli.add_option("-r,--route", a.route, "Route: an INI file, or the name of one in share/viwo/routes")
	    ->type_name("FILE.ini")
	    ->capture_default_str()
	    ->excludes(sequence);
	cli.add_option("-g,--rig", a.rig, "Robot and sensors: an INI file, or the name of one in share/viwo/rigs")
	    ->type_name("FILE.ini")
	    ->capture_default_str()
	    ->excludes(sequence);
	cli.add_option("-s,--seed", a.seed, "Seed of all random draws: same inputs and seed, same files")
	    ->check(app::seed())
	    ->capture_default_str();
	cli.add_option("-o,--output", a.output, "X.rawlog; X_Images/, X_ground_truth.tum and X_simulation.ini are written beside it")
	    ->type_name("FILE.rawlog")
	    ->required();
	cli.add_flag("--no-images", a.no_images, "Without the camera (seconds instead of minutes)");
	cli.add_option("--images-from", a.images_from, "Take over the images of a run that differs in wheels, IMU or LiDAR alone: its X_Images")
	    ->check(CLI::ExistingDirectory);
	cli.add_option("--set", a.overrides, "section.key=value: overrule an option of rig or route; may be given several times")->take_all();
	cli.add_option("-j,--jobs", a.jobs, "Threads that render; the files do not depend on it")
	    ->check(CLI::Range(1, 256))
	    ->default_str("number of processors");
	cli.footer(
	    "Examples:\n"
	    "  viwo-sim -o run.rawlog\n"
	    "  viwo-sim --sequence seq05 --seed 1 -o seq05.rawlog\n"
	    "  viwo-sim --world lobby --route lobby_arc --seed 3 -o arc.rawlog\n"
	    "  viwo-sim --route my_route.ini --set wheels.slips='20 2 0.3 0' -o slip.rawlog\n"
	    "  viwo-sim --set camera.black_from_s=30 --set camera.black_to_s=35 -o black.rawlog\n"
	    "  viwo-sim --set wheels.silences='30 5' --set imu.stamp_jitter_ms=2 --set camera.exposure_steps='30 0.5 40 1' -o hard.rawlog\n"
	    "  viwo-sim --no-images --set floor.height_rms_mm=0 --set vibration.acceleration_m_s2=0 -o smooth.rawlog\n"
	    "All options with their units: share/viwo/rigs/turtlebot2.ini, share/viwo/routes/sample.ini.\n"
	    "Exit status: 0 done, 1 failed or interrupted (what is finished is a valid, shorter log), 2 bad usage.");
}

/** A file as named, or a shipped one by its short name. */
std::string resolve(const std::string& name, const std::string& shipped_folder)
{
	const std::filesystem::path path(name);
	if (std::filesystem::is_regular_file(path) || path.has_parent_path() || path.extension() == ".ini") return name;
	return app::findShare(shipped_folder + "/" + name + ".ini");
}

int simulate(Arguments& a)
{
	if (!a.sequence.empty())
	{
		const sim::Sequence sequence = sim::Sequence::load(resolve(a.sequence, "sequences"));
		a.world = sequence.world;
		a.route = sequence.route;
		a.rig = sequence.rig;
	}
	sim::Rig rig;
	sim::Route route;
	sim::loadRun(resolve(a.rig, "rigs"), resolve(a.route, "routes"), a.overrides, rig, route);
	sim::Simulation simulation(sim::World::load(resolve(a.world, "worlds")), route, rig, a.seed);

	app::ProgressBar bar;
	sim::SimulationRunOptions options;
	options.images = !a.no_images;
	options.images_from = a.images_from;
	options.threads = a.jobs;
	options.progress = [&](double fraction)
	{
		bar.update(fraction);
		return !app::interrupted();
	};
	const sim::SimulationResult result = simulation.run(a.output, options);
	bar.clear();
	if (!app::quiet())
		std::printf("%s: %.1f s, %.2f m; %lld images, %lld IMU, %lld odometry, %lld scans\n%s\n", result.rawlog.c_str(), result.duration_s,
		            result.length_m, static_cast<long long>(result.images), static_cast<long long>(result.imu),
		            static_cast<long long>(result.odometry), static_cast<long long>(result.scans), result.ground_truth.c_str());
	if (result.interrupted) throw Error("interrupted; " + result.rawlog + " ends at " + std::to_string(result.duration_s) + " s");
	return 0;
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli("Simulates a wheeled robot with camera, IMU, wheel encoders and LiDAR: a rawlog with its exact ground truth.", "viwo-sim");
	Arguments arguments;
	declare(cli, arguments);
	return app::run(cli, argc, argv, [&] { return simulate(arguments); });
}
