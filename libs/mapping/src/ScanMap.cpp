#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/mapping/ScanMap.h>
#include <viwo/rawlog/ObjectFile.h>

#include <cmath>

namespace viwo
{
namespace
{
using mrpt::maps::COccupancyGridMap2D;
using mrpt::obs::CObservation2DRangeScan;

/** Ends of the valid beams in O, x and y only. */
std::vector<Eigen::Vector2d> beamEnds_O(const CObservation2DRangeScan& scan, double farthest_m)
{
	const Pose3 T_OL = fromMrpt(scan.sensorPose);
	const size_t n = scan.getScanSize();
	const double step = n > 1 ? static_cast<double>(scan.aperture) / static_cast<double>(n - 1) : 0;
	std::vector<Eigen::Vector2d> ends;
	for (size_t i = 0; i < n; ++i)
	{
		const double range_m = static_cast<double>(scan.getScanRange(i));
		if (!scan.getScanRangeValidity(i) || range_m > farthest_m) continue;
		const double angle = (step * static_cast<double>(i) - 0.5 * static_cast<double>(scan.aperture)) * (scan.rightToLeft ? 1 : -1);
		ends.emplace_back((T_OL.R * Eigen::Vector3d(range_m * std::cos(angle), range_m * std::sin(angle), 0) + T_OL.p).head<2>());
	}
	return ends;
}

void sizeFor(const std::vector<PosedScan>& scans, double resolution_m, double farthest_m, COccupancyGridMap2D& grid)
{
	Eigen::Vector2d min = scans.front().T_WO.p.head<2>(), max = min;
	for (const PosedScan& posed : scans)
		for (const Eigen::Vector2d& end_O : beamEnds_O(*posed.scan, farthest_m))
		{
			const Eigen::Vector2d end_W = (posed.T_WO.R * Eigen::Vector3d(end_O.x(), end_O.y(), 0) + posed.T_WO.p).head<2>();
			min = min.cwiseMin(end_W);
			max = max.cwiseMax(end_W);
		}
	min = (min.array() - 1).floor();
	max = (max.array() + 1).ceil();
	grid.setSize(static_cast<float>(min.x()), static_cast<float>(max.x()), static_cast<float>(min.y()), static_cast<float>(max.y()),
	             static_cast<float>(resolution_m));
}
}  // namespace

COccupancyGridMap2D gridOf(const std::vector<PosedScan>& scans, double resolution_m, double farthest_m)
{
	if (scans.empty()) throw Error("no scan to draw into a grid map");
	COccupancyGridMap2D grid;
	sizeFor(scans, resolution_m, farthest_m, grid);
	grid.insertionOptions.maxDistanceInsertion = static_cast<float>(farthest_m);
	grid.insertionOptions.considerInvalidRangesAsFreeSpace = false;
	grid.insertionOptions.wideningBeamsWithDistance = false;
	for (const PosedScan& posed : scans) grid.insertObservation(*posed.scan, toMrpt(posed.T_WO));
	return grid;
}

mrpt::maps::CSimpleMap simpleMapOf(const std::vector<PosedScan>& scans)
{
	mrpt::maps::CSimpleMap map;
	for (const PosedScan& posed : scans)
	{
		auto frame = mrpt::obs::CSensoryFrame::Create();
		frame->insert(posed.scan);
		map.insert(mrpt::poses::CPose3DPDFGaussian::Create(toMrpt(posed.T_WO)), frame);
	}
	return map;
}
}  // namespace viwo
