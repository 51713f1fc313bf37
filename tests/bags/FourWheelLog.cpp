#include <viwo/app/Program.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/importers/RosBagImporter.h>

#include <filesystem>

#include "RobotBag.h"

using namespace viwo;

namespace
{
struct Arguments
{
	std::string input, output;
	testing::RobotBagOptions bag{true};
	double wheel_radius_m = 0.035, track_m = 0.23;
};

int convert(const Arguments& a)
{
	namespace fs = std::filesystem;
	const std::string stem = fs::path(a.output).replace_extension().string(), bag = stem + ".bag", map = stem + "_map.ini";
	const std::string truth = fs::path(a.input).replace_extension().string() + "_ground_truth.tum";
	testing::writeRobotBag(a.input, truth, bag, a.bag);
	writeAtomically(map, testing::fourWheelMap(a.wheel_radius_m, a.track_m, true));
	importRosBags({"", a.output, [](double) { return !app::interrupted(); }}, {{bag}, map, false});
	fs::remove(bag);
	return 0;
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli("A rawlog by way of a ROS bag whose wheels are four joints, and its import.", "viwo_four_wheel_log");
	Arguments a;
	cli.add_option("rawlog", a.input, "With absolute ticks, and X_ground_truth.tum beside it")->required();
	cli.add_option("-o,--output", a.output, "X.rawlog")->required();
	cli.add_option("--wheel-radius", a.wheel_radius_m, "By which the joints' angles become metres")->capture_default_str();
	cli.add_option("--track", a.track_m, "By which they become a yaw rate, m")->capture_default_str();
	return app::run(cli, argc, argv, [&] { return convert(a); });
}
