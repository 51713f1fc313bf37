#include <viwo/app/Program.h>
#include <viwo/importers/CarmenImporter.h>
#include <viwo/importers/EurocImporter.h>
#include <viwo/importers/KittiImporter.h>

#include <cstdio>
#include <iostream>

using namespace viwo;

namespace
{
void addFiles(CLI::App& command, ImportJob& job)
{
	command.add_option("recording", job.folder, "The recording: its folder, or the log's file")->required();
	command.add_option("-o,--output", job.rawlog_path, "X.rawlog; images go to X_Images/, the ground truth to X_ground_truth.tum")
	    ->required();
}

void print(const ImportJob& job, const ImportResult& result)
{
	const char* rawlog = job.rawlog_path.c_str();
	if (result.scans > 0)
		std::printf("%s: %zu scans, %zu odometry samples in %.3f s\n", rawlog, result.scans, result.odometry_samples, result.duration_s);
	else
		std::printf("%s: %zu images, %zu IMU samples, %zu odometry samples in %.3f s\n", rawlog, result.images, result.imu_samples,
		            result.odometry_samples, result.duration_s);
	if (!result.stamps_path.empty()) std::printf("%s: original stamps\n", result.stamps_path.c_str());
	if (!result.ground_truth_path.empty()) std::printf("%s: %zu poses of O\n", result.ground_truth_path.c_str(), result.ground_truth_poses);
	std::fflush(stdout);
	if (app::quiet()) return;
	for (const std::string& note : result.notes) std::cerr << "viwo-import: note: " << note << std::endl;
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
	cli.footer(
	    "Examples:\n"
	    "  viwo-import euroc V1_01_easy -o v101.rawlog\n"
	    "  viwo-import kitti 2011_09_26_drive_0005_extract -o drive.rawlog --speed-noise 0.05 --speed-scale 1.01 --seed 3\n"
	    "  viwo-import carmen intel.clf.bz2 -o intel.rawlog\n"
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
		                else
			                result = importCarmen(job);
		                bar.clear();
		                print(job, result);
		                return 0;
	                });
}
