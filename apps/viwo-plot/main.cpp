#include <viwo/app/Program.h>
#include <viwo/core/Trajectory.h>
#include <viwo/evaluation/PlotSvg.h>
#include <viwo/mapping/Landmarks.h>
#include <viwo/mapping/MapPlot.h>
#include <viwo/mapping/OctreeFiles.h>

#include <cstdio>
#include <filesystem>

using namespace viwo;

namespace
{
struct Arguments
{
	std::string output, map, octomap, landmarks, title;
	std::vector<std::string> trajectories;
	HeightSlice slice;
};

void declare(CLI::App& cli, Arguments& a)
{
	cli.add_option("-o,--output", a.output, "Picture: .png or .svg")->type_name("FILE.png|.svg")->required()->check(app::notEmpty());
	auto* map = cli.add_option("--map", a.map, "Grid map of ROS's map_server (.yaml)")->type_name("FILE.yaml");
	CLI::Option* octomap = cli.add_option("--octomap", a.octomap, "OctoMap (.bt or .ot), seen from above between two heights")
	                           ->type_name("FILE.bt|.ot")
	                           ->excludes(map);
	cli.add_option("--min-z", a.slice.min_z_m,
	               "Of the OctoMap: from this height on, m (0.05; of a flat map its lowest); --min-z = --max-z is a slice")
	    ->needs(octomap)
	    ->check(app::finite());
	cli.add_option("--max-z", a.slice.max_z_m, "Up to this height, m (2; of a flat map its highest)")->needs(octomap)->check(app::finite());
	cli.add_option("--landmarks", a.landmarks, "Landmarks of viwo-odometry (.ply)")->type_name("FILE.ply");
	cli.add_option("-t,--trajectory", a.trajectories, "Trajectory (TUM) to draw on top; may be given several times")->type_name("FILE.tum");
	cli.add_option("--title", a.title, "Line above the picture");
	cli.footer(
	    "All are drawn in the same frame, as they are.\n"
	    "Examples:\n"
	    "  viwo-plot -o map.png --map truth/map.yaml -t truth/trajectory.tum\n"
	    "  viwo-plot -o slice.svg --octomap run.bt --min-z 0.2 --max-z 0.2 -t out/trajectory.tum\n"
	    "  viwo-plot -o landmarks.png --landmarks out/landmarks.ply -t out/trajectory.tum -t out_wheel/trajectory.tum\n"
	    "Exit status: 0 done, 1 failed, 2 bad usage.");
}

OccupancyImage sliceOf(const Arguments& a)
{
	try
	{
		return loadProjection(a.octomap, a.slice);
	}
	catch (const Error& e)
	{
		const std::string what = e.what();
		throw Error(what + (what.find("between the heights") == std::string::npos ? "" : "; set --min-z and --max-z"));
	}
}

MapPlot plotOf(const Arguments& a)
{
	MapPlot plot;
	plot.title = a.title;
	if (!a.map.empty()) plot.map = loadMapServer(a.map);
	if (!a.octomap.empty()) plot.map = sliceOf(a);
	if (!a.landmarks.empty())
	{
		PlotLayer layer{"landmarks", {120, 120, 120}, PlotLayer::Kind::points, {}, a.landmarks};
		for (const Landmark& landmark : loadLandmarks(a.landmarks)) layer.points_m.emplace_back(landmark.p_W.head<2>());
		plot.layers.push_back(layer);
	}
	const std::vector<std::string> names = legendNames(a.trajectories);
	for (size_t i = 0; i < names.size(); ++i)
	{
		PlotLayer layer{names[i], plotColour(i), PlotLayer::Kind::path, {}, a.trajectories[i]};
		const Trajectory trajectory = Trajectory::loadTum(a.trajectories[i]);
		for (const StampedPose& pose : trajectory.poses()) layer.points_m.emplace_back(pose.T.p.head<2>());
		plot.layers.push_back(layer);
	}
	return plot;
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli{"Maps, landmarks and trajectories from above, as PNG or SVG", "viwo-plot"};
	Arguments arguments;
	declare(cli, arguments);
	return app::run(
	    cli, argc, argv,
	    [&]
	    {
		    const std::string extension = std::filesystem::path(arguments.output).extension().string();
		    if (extension != ".png" && extension != ".svg")
			    throw app::UsageError(arguments.output + ": a picture's name ends in .png or .svg");
		    if (arguments.map.empty() && arguments.octomap.empty() && arguments.landmarks.empty() && arguments.trajectories.empty())
			    throw app::UsageError("nothing to draw: give --map, --octomap, --landmarks or --trajectory");
		    const HeightSlice& slice = arguments.slice;
		    if (slice.min_z_m.value_or(HeightSlice::kMin_z_m) > slice.max_z_m.value_or(HeightSlice::kMax_z_m))
			    throw app::UsageError("--max-z (2 unless given) is below --min-z (0.05 unless given)");
		    saveMapPlot(arguments.output, plotOf(arguments));
		    std::printf("%s\n", arguments.output.c_str());
		    return 0;
	    });
}
