#include <viwo/app/Program.h>

#include <iostream>

#include "RobotBag.h"

using namespace viwo;

int main(int argc, char** argv)
{
	CLI::App cli("A rawlog as the ROS 1 bag that the same robot would have recorded: to try doc/tutorial.md without a bag of one's own.",
	             "viwo_rawlog_to_bag");
	std::string rawlog, bag;
	testing::RobotBagOptions options;
	cli.add_option("rawlog", rawlog, "With images in files of their own")->required();
	cli.add_option("-o,--output", bag, "X.bag")->required();
	cli.add_flag("--four-wheels", options.four_wheels,
	             "Wheels as a JointState of four joints, of the rawlog's ticks, instead of an Odometry; prints the map for viwo-import");
	return app::run(cli, argc, argv,
	                [&]
	                {
		                testing::writeRobotBag(rawlog, "", bag, options);
		                if (options.four_wheels) std::cout << testing::fourWheelMap(0.035, 0.23, false);
		                return 0;
	                });
}
