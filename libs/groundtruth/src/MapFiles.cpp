#include "MapFiles.h"

#include <mrpt/core/format.h>
#include <viwo/core/Error.h>
#include <viwo/mapping/MapPlot.h>
#include <viwo/mapping/ScanMap.h>
#include <viwo/rawlog/ObjectFile.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <limits>

namespace viwo::gt
{
namespace
{
constexpr double kMostCells = 3e8;

mrpt::obs::CObservation2DRangeScan::Ptr observationOf(const Scan& scan)
{
	return std::make_shared<mrpt::obs::CObservation2DRangeScan>(makeScan(scan.t_ns, scan.ranges_m,
	                                                                     scan.step_rad * static_cast<double>(scan.ranges_m.size() - 1),
	                                                                     static_cast<double>(scan.max_range_m), scan.T_OL, "LIDAR"));
}

Pose3 pose3(const Pose2& T)
{
	return Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(T.yaw, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(T.p.x(), T.p.y(), 0));
}

/** The stretches of one flag: a line to each pose that has it. */
PlotLayer stretchesOf(PoseFlag flag, PlotColour colour, const std::vector<FinalPose>& poses)
{
	PlotLayer layer;
	layer.name = nameOf(flag);
	layer.colour = colour;
	for (size_t i = 1; i < poses.size(); ++i)
	{
		if (poses[i].flag != flag) continue;
		if (layer.points_m.empty() || poses[i - 1].flag != flag)
		{
			layer.points_m.push_back(Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
			layer.points_m.push_back(poses[i - 1].T.p);
		}
		layer.points_m.push_back(poses[i].T.p);
	}
	return layer;
}

MapPlot pictureOf(OccupancyImage map, const std::vector<FinalPose>& poses)
{
	MapPlot plot;
	plot.map = std::move(map);
	plot.layers = {stretchesOf(PoseFlag::good, {40, 160, 60}, poses), stretchesOf(PoseFlag::degenerate, {255, 140, 0}, poses),
	               stretchesOf(PoseFlag::odometry_only, {220, 40, 40}, poses)};
	return plot;
}
/** @throws Error for a map that no memory holds, before it is tried. */
void checkSize(const std::vector<FinalPose>& poses, double resolution_m)
{
	Eigen::Vector2d min = poses.front().T.p, max = min;
	for (const FinalPose& pose : poses)
	{
		min = min.cwiseMin(pose.T.p);
		max = max.cwiseMax(pose.T.p);
	}
	const Eigen::Vector2d size_m = max - min;
	if (size_m.allFinite() && size_m.prod() < kMostCells * resolution_m * resolution_m) return;
	throw Error(mrpt::format("the way covers %.3g x %.3g m, too much for a map in cells of %g m: choose a coarser --resolution", size_m.x(),
	                         size_m.y(), resolution_m));
}
}  // namespace

void writeMaps(const std::string& dir, const Session& session, const KeyScans& keys, const std::vector<FinalPose>& poses,
               double resolution_m)
{
	checkSize(poses, resolution_m);
	std::vector<PosedScan> scans;
	for (size_t k = 0; k < keys.size(); ++k) scans.push_back({observationOf(session.scans[keys.scan[k]]), pose3(keys.poses[k])});
	const mrpt::maps::COccupancyGridMap2D grid = gridOf(scans, resolution_m);
	const OccupancyImage image = occupancyImage(grid);
	saveMapServer(dir + "/map.yaml", image);
	saveObject(dir + "/map.gridmap.gz", grid);
	saveObject(dir + "/map.simplemap", simpleMapOf(scans));
	saveMapPlot(dir + "/map.png", pictureOf(image, poses));
}
}  // namespace viwo::gt
