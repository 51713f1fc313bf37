#include <viwo/app/Program.h>
#include <viwo/core/NumberText.h>
#include <viwo/importers/CarmenImporter.h>
#include <viwo/importers/EurocImporter.h>
#include <viwo/importers/KittiImporter.h>
#include <viwo/importers/RosBagImporter.h>

#include <cstdio>

using namespace viwo;

namespace
{
void addOutput(CLI::App& command, ImportJob& job)
{
	command.add_option("-o,--output", job.rawlog_path, "X.rawlog; images go to X_Images/, the ground truth to X_ground_truth.tum")
	    ->type_name("FILE.rawlog")
	    ->required();
}

void addFiles(CLI::App& command, ImportJob& job)
{
	command.add_option("recording", job.folder, "The recording: its folder, or the log's file")->type_name("FILE")->required();
	addOutput(command, job);
}

CLI::App* addRosBag(CLI::App& cli, ImportJob& job, RosBagOptions& options)
{
	CLI::App* command = cli.add_subcommand("rosbag", "ROS 1 bags (plain, bz2, lz4), several as one recording");
	command->add_option("bags", options.bags, "A.bag [B.bag ...]")->type_name("FILE.bag")->required();
	addOutput(*command, job);
	CLI::Option* map = command->add_option("--map", options.map_path, "Which topic becomes which label, an INI as --auto prints it")
	                       ->type_name("FILE.ini");
	command->add_flag("--auto", "Propose that from the topics, print it and use it (the default)")->excludes(map);
	command->add_flag("--record-time", options.record_time, "Stamps are the recorder's, not those of the headers");
	return command;
}

void print(const ImportJob& job, const ImportResult& result)
{
	const char* separator = "";
	std::printf("%s%s: ", result.mapping.empty() ? "" : "\n", job.rawlog_path.c_str());
	const auto count = [&separator](size_t number, const char* what, bool always = false)
	{
		if (number == 0 && !always) return;
		std::printf("%s%s", separator, counted(number, what).c_str());
		separator = ", ";
	};
	const bool of_lasers = result.scans > 0 && result.images == 0 && result.imu_samples == 0;
	count(result.scans, "scan");
	count(result.images, "image", !of_lasers);
	count(result.imu_samples, "IMU sample", !of_lasers);
	count(result.odometry_samples, "odometry sample", true);
	count(result.gps_fixes, "GPS reading");
	count(result.point_clouds, "point cloud");
	std::printf(" in %.3f s\n", result.duration_s);
	if (!result.stamps_path.empty()) std::printf("%s: original stamps\n", result.stamps_path.c_str());
	if (!result.ground_truth_path.empty())
		std::printf("%s: %s%s\n", result.ground_truth_path.c_str(), counted(result.ground_truth_poses, "pose").c_str(),
		            result.ground_truth_assumed ? ", taken for those of O" : " of O");
	if (!result.gps_path.empty()) std::printf("%s: positions of the GPS antenna\n", result.gps_path.c_str());
	std::fflush(stdout);
	app::tellNotes(result.notes);
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli{"Recordings in other layouts as rawlogs", "viwo-import"};
	ImportJob job;
	KittiOptions kitti_options;
	cli.require_subcommand(1);
	cli.fallthrough();
	CLI::App* euroc = cli.add_subcommand("euroc", "A sequence in EuRoC's ASL layout (mav0/cam0, imu0, and odom0 if there)");
	addFiles(*euroc, job);
	CLI::App* kitti = cli.add_subcommand("kitti", "A drive in KITTI's raw layout (image_00, oxts, calib_*.txt here or above)");
	addFiles(*kitti, job);
	kitti->add_option("--speed-noise", kitti_options.speed_noise_m_s, "Standard deviation of noise added to the forward speed, m/s")
	    ->check(app::nonNegative())
	    ->capture_default_str();
	kitti->add_option("--speed-scale", kitti_options.speed_scale, "Factor on the forward speed")
	    ->check(app::positive())
	    ->capture_default_str();
	kitti->add_option("--seed", kitti_options.seed, "Of the speed noise")->check(app::seed())->capture_default_str();
	CLI::App* carmen = cli.add_subcommand("carmen", "A CARMEN log with scans and odometry (plain, .gz or .bz2)");
	addFiles(*carmen, job);
	RosBagOptions bag_options;
	bag_options.show_mapping = [](const std::string& mapping)
	{
		std::fputs(mapping.c_str(), stdout);
		std::fflush(stdout);
	};
	CLI::App* rosbag = addRosBag(cli, job, bag_options);
	cli.footer(
	    "Examples:\n"
	    "  viwo-import euroc V1_01_easy -o v101.rawlog\n"
	    "  viwo-import kitti 2011_09_26_drive_0005_extract -o drive.rawlog --speed-noise 0.05 --speed-scale 1.01 --seed 3\n"
	    "  viwo-import carmen intel.clf.bz2 -o intel.rawlog\n"
	    "  viwo-import rosbag run_1.bag run_2.bag -o run.rawlog\n"
	    "  viwo-import rosbag run.bag -o run.rawlog --map robot.ini\n"
	    "Exit status: 0 done, 1 failed, 2 bad usage.");

	return app::run(cli, argc, argv,
	                [&]
	                {
		                app::ProgressBar bar;
		                job.proceed = [&bar](double fraction)
		                {
			                bar.update(fraction, "copying");
			                return !app::interrupted();
		                };
		                ImportResult result;
		                if (euroc->parsed())
			                result = importEuroc(job);
		                else if (kitti->parsed())
			                result = importKitti(job, kitti_options);
		                else if (rosbag->parsed())
			                result = importRosBags(job, bag_options);
		                else
			                result = importCarmen(job);
		                bar.clear();
		                print(job, result);
		                return 0;
	                });
}
