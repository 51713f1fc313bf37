#include <viwo/app/Program.h>

#include <vector>

#include "Command.h"

using namespace viwo;

int main(int argc, char** argv)
{
	CLI::App cli{"Calibration of a robot's camera, IMU and wheels", "viwo-calibrate"};
	cli.require_subcommand(1);
	cli.fallthrough();
	const std::vector<calibrate::Command> commands{calibrate::addImport(cli), calibrate::addEstimate(cli), calibrate::addAllan(cli)};
	cli.footer(
	    "Examples:\n"
	    "  viwo-calibrate import --kalibr camchain-imucam.yaml --imu imu.yaml --odom 0 0.3 -0.1 90 -90 0 -o rig.ini\n"
	    "  viwo-calibrate import --ros left.yaml -o camera.ini\n"
	    "  viwo-calibrate estimate -i calibration.rawlog -o rig.ini --html report.html\n"
	    "  viwo-calibrate estimate -i calibration.rawlog -t lidar.tum --rig measured.ini -o rig.ini\n"
	    "  viwo-calibrate allan -i standing.rawlog --svg allan.svg -o imu.ini\n"
	    "  viwo-odometry -i run.rawlog --rig rig.ini -o out\n"
	    "  rawlog-edit --camera-params CAM,rig.ini -i run.rawlog -o calibrated.rawlog\n"
	    "Exit status: 0 done, 1 failed, 2 bad usage.");
	return app::run(cli, argc, argv,
	                [&]
	                {
		                for (const calibrate::Command& command : commands)
			                if (command.app->parsed()) return command.run();
		                return 2;  // CLI11 requires one
	                });
}
