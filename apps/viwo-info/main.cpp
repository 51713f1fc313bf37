#include <viwo/app/Program.h>
#include <viwo/importers/RecordingInfo.h>

#include <iostream>

using namespace viwo;

int main(int argc, char** argv)
{
	CLI::App cli{"What is inside of a recording, and what it suffices for", "viwo-info"};
	std::vector<std::string> paths;
	cli.add_option("recordings", paths, "Rawlog, ROS 1 bag, CARMEN log, EuRoC or KITTI folder; several are described one by one")
	    ->type_name("FILE")
	    ->required();
	cli.footer(
	    "Examples:\n"
	    "  viwo-info run.rawlog\n"
	    "  viwo-info run.bag\n"
	    "Exit status: 0 done, 1 failed, 2 bad usage.");
	return app::run(cli, argc, argv,
	                [&]
	                {
		                for (const std::string& path : paths)
		                {
			                app::ProgressBar bar;
			                const RecordingInfo info = inspectRecording(path,
			                                                            [&bar](double fraction)
			                                                            {
				                                                            bar.update(fraction, "reading");
				                                                            return !app::interrupted();
			                                                            });
			                bar.clear();
			                std::cout << (&path == &paths.front() ? "" : "\n") << describeRecording(info) << std::flush;
		                }
		                return 0;
	                });
}
