#include <viwo/app/Program.h>
#include <viwo/core/NumberText.h>
#include <viwo/odometry/OdometryRun.h>

#include <algorithm>
#include <cstdio>

using namespace viwo;

namespace
{
struct Arguments
{
	OdometryRunOptions run;
	std::string rig;
	std::string mode = "viwo";
	std::string pose_frame = "O";
	bool realtime = false;
	double speed = 1;
};

void declare(CLI::App& cli, Arguments& a)
{
	cli.add_option("-i,--input", a.run.rawlogs,
	               "Rawlog with images, IMU and wheel odometry; several, in the order of their time, are one run; - is standard input")
	    ->type_name("FILE.rawlog")
	    ->required()
	    ->check(app::notEmpty());
	cli.add_option("-c,--config", a.run.config_path, "Configuration (INI); without it the defaults for a TurtleBot-class robot")
	    ->type_name("FILE.ini")
	    ->check(app::notEmpty());
	cli.add_option("--rig", a.rig, "Calibration (rig.ini of viwo-calibrate) that counts instead of the rawlog's")
	    ->type_name("FILE.ini")
	    ->check(app::notEmpty());
	cli.add_option("-o,--output", a.run.output_dir, "Folder for what is computed")->type_name("DIR")->required()->check(app::notEmpty());
	cli.add_option("--mode", a.mode, "What is fused: wheel, wio (wheels + IMU), vio (camera + IMU), viwo (all)")
	    ->check(CLI::IsMember(modeNames()))
	    ->capture_default_str();
	cli.add_option("--pose-frame", a.pose_frame, "Whose pose is written: O (vehicle), B (IMU), C (camera)")
	    ->check(CLI::IsMember({"O", "B", "C"}))
	    ->capture_default_str();
	cli.add_option("--from", a.run.from_s, "Start here, s from the first stamp of the labels in use")->check(app::nonNegative());
	cli.add_option("--to", a.run.to_s, "Stop here, s from the first stamp of the labels in use")->check(app::nonNegative());
	CLI::Option* const realtime = cli.add_flag("--realtime", a.realtime, "Replay by the log's clock");
	cli.add_option("--speed", a.speed, "With --realtime: times the log's clock")
	    ->check(app::positive())
	    ->capture_default_str()
	    ->needs(realtime);
	cli.add_flag("--allow-truncated", a.run.allow_truncated, "Take a truncated rawlog as far as it goes");
	cli.footer(
	    "Writes trajectory.tum (one pose a frame), trajectory_imu_rate.tum, trajectory_covariance.csv, landmarks.ply, summary.json, "
	    "config.ini.\n"
	    "Examples:\n"
	    "  viwo-odometry -i run.rawlog -o out\n"
	    "  viwo-odometry -i run.rawlog -c my_robot.ini -o out --mode wio\n"
	    "  viwo-odometry -i run.rawlog -o out --from 30 --to 60 --pose-frame C\n"
	    "  viwo-odometry -i morning_1.rawlog -i morning_2.rawlog -o out\n"
	    "  ssh robot cat run.rawlog | viwo-odometry -i - -o out\n"
	    "Exit status: 0 done, 1 failed, 2 bad usage.");
}

void printResult(const OdometryRunOptions& run, const OdometryRunResult& r)
{
	std::printf("%s of %s, %.1f s, path %.3f m, status %s, %.1f x real time\n", counted(static_cast<size_t>(r.poses), "pose").c_str(),
	            counted(static_cast<size_t>(r.frames), "frame").c_str(), r.duration_s, r.path_length_m, r.final_status.c_str(),
	            r.wall_time_s > 0 ? r.duration_s / r.wall_time_s : 0.0);
	if (run.replay_speed > 0) std::printf("replay by the log's clock, at most %.1f s behind, nothing dropped\n", r.largest_lag_s);
	std::printf("%s\n%s\n", (run.output_dir + "/trajectory.tum").c_str(), r.summary_path.c_str());
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli("Visual-inertial-wheel odometry: a rawlog in, a metric trajectory out.", "viwo-odometry");
	Arguments a;
	declare(cli, a);
	return app::run(cli, argc, argv,
	                [&]
	                {
		                if (a.run.to_s <= a.run.from_s) throw app::UsageError("--to must be later than --from");
		                std::replace(a.run.rawlogs.begin(), a.run.rawlogs.end(), std::string("-"), std::string("/dev/stdin"));
		                if (!a.run.config_path.empty()) a.run.odometry.load(a.run.config_path);
		                if (!a.rig.empty())
		                {
			                a.run.rig = std::make_shared<RigFile>(RigFile::load(a.rig));
			                a.run.odometry.use(*a.run.rig);
		                }
		                const auto mode = std::find(modeNames().begin(), modeNames().end(), a.mode);
		                a.run.odometry.estimator.mode = static_cast<Mode>(mode - modeNames().begin());
		                a.run.pose_frame = a.pose_frame == "B" ? PoseFrame::B : a.pose_frame == "C" ? PoseFrame::C : PoseFrame::O;
		                a.run.replay_speed = a.realtime ? a.speed : 0;

		                app::ProgressBar bar;
		                OdometryRunHooks hooks;
		                hooks.progress = [&](double fraction, const std::string& note) { bar.update(fraction, note); };
		                hooks.interrupted = [] { return app::interrupted(); };
		                if (!app::quiet())
			                hooks.log = [&](const std::string& line)
			                {
				                bar.clear();
				                std::fprintf(stderr, "%s\n", line.c_str());
			                };
		                const OdometryRunResult result = runOdometry(a.run, hooks);
		                bar.clear();
		                printResult(a.run, result);
		                if (!result.doubt.empty()) throw Error(result.doubt);
		                if (!result.left_out.empty()) throw Error(result.left_out);
		                return result.interrupted ? 1 : 0;
	                });
}
