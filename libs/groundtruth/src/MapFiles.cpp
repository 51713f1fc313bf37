#include "MapFiles.h"

#include "MapPicture.h"

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace viwo::gt
{
namespace
{
using mrpt::maps::COccupancyGridMap2D;

constexpr float kOccupied = 0.35f, kFree = 0.65f;  // of MRPT's cells, which hold the probability of being free
constexpr double kFarthest_m = 30;                 //!< beams are drawn this far: farther ones open gaps between them

mrpt::obs::CObservation2DRangeScan observationOf(const Scan& scan, const ScanOptions& options)
{
	std::vector<float> ranges = scan.ranges_m;
	for (float& r : ranges)
		if (static_cast<double>(r) < options.min_range_m || static_cast<double>(r) > options.max_range_m) r = 0;
	return makeScan(scan.t_ns, ranges, scan.step_rad * static_cast<double>(ranges.size() - 1), static_cast<double>(scan.max_range_m),
	                scan.T_OL, "LIDAR");
}

mrpt::poses::CPose3D pose3(const Pose2& T)
{
	return mrpt::poses::CPose3D(T.p.x(), T.p.y(), 0, T.yaw, 0, 0);
}

void sizeFor(const KeyScans& keys, double resolution_m, COccupancyGridMap2D& grid)
{
	Eigen::Vector2d min = keys.poses.front().p, max = min;
	for (size_t k = 0; k < keys.size(); ++k)
		for (const OrientedPoint& point : keys.clouds[k])
		{
			if ((point.p).norm() > kFarthest_m) continue;
			const Eigen::Vector2d p = keys.poses[k] * point.p;
			min = min.cwiseMin(p);
			max = max.cwiseMax(p);
		}
	min = (min.array() - 1).floor();
	max = (max.array() + 1).ceil();
	grid.setSize(static_cast<float>(min.x()), static_cast<float>(max.x()), static_cast<float>(min.y()), static_cast<float>(max.y()),
	             static_cast<float>(resolution_m));
}

/** One byte a cell, first row on top. */
std::vector<uint8_t> trinary(const COccupancyGridMap2D& grid)
{
	std::vector<uint8_t> bytes;
	for (int y = static_cast<int>(grid.getSizeY()) - 1; y >= 0; --y)
		for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x)
		{
			const float free = grid.getCell(x, y);
			bytes.push_back(free < kOccupied ? 0 : free > kFree ? 254 : 205);
		}
	return bytes;
}

void writeMapServer(const std::string& dir, const COccupancyGridMap2D& grid, const std::vector<uint8_t>& bytes)
{
	AtomicFile pgm(dir + "/map.pgm");
	pgm.stream() << "P5\n" << grid.getSizeX() << " " << grid.getSizeY() << "\n255\n";
	pgm.stream().write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
	pgm.commit();
	AtomicFile yaml(dir + "/map.yaml");
	char text[512];
	std::snprintf(text, sizeof text,
	              "image: map.pgm\nmode: trinary\nresolution: %.6f\norigin: [%.6f, %.6f, 0.0]\nnegate: 0\noccupied_thresh: "
	              "0.65\nfree_thresh: 0.196\n",
	              static_cast<double>(grid.getResolution()), static_cast<double>(grid.getXMin()), static_cast<double>(grid.getYMin()));
	yaml.stream() << text;
	yaml.commit();
}

template <class Object>
void writeObject(const std::string& path, const Object& object)
{
	const std::string temporary = path + ".part";
	{
		mrpt::io::CFileGZOutputStream file;
		if (!file.open(temporary)) throw Error(path + ": cannot be written; check folder and free space");
		auto archive = mrpt::serialization::archiveFrom(file);
		archive << object;
	}
	std::error_code error;
	std::filesystem::rename(temporary, path, error);
	if (error) throw Error(path + ": cannot be written: " + error.message());
}
}  // namespace

void writeMaps(const std::string& dir, const Session& session, const KeyScans& keys, const std::vector<FinalPose>& poses,
               const ScanOptions& scan, double resolution_m)
{
	COccupancyGridMap2D grid;
	sizeFor(keys, resolution_m, grid);
	grid.insertionOptions.maxDistanceInsertion = static_cast<float>(kFarthest_m);
	grid.insertionOptions.considerInvalidRangesAsFreeSpace = false;
	grid.insertionOptions.wideningBeamsWithDistance = false;
	mrpt::maps::CSimpleMap frames;
	for (size_t k = 0; k < keys.size(); ++k)
	{
		const auto observation = observationOf(session.scans[keys.scan[k]], scan);
		const mrpt::poses::CPose3D pose = pose3(keys.poses[k]);
		grid.insertObservation(observation, pose);
		auto frame = mrpt::obs::CSensoryFrame::Create();
		frame->insert(std::make_shared<mrpt::obs::CObservation2DRangeScan>(observation));
		frames.insert(mrpt::poses::CPose3DPDFGaussian::Create(pose), frame);
	}
	const std::vector<uint8_t> bytes = trinary(grid);
	writeMapServer(dir, grid, bytes);
	writeObject(dir + "/map.gridmap.gz", grid);
	writeObject(dir + "/map.simplemap", frames);
	writeMapPicture(dir + "/map.png",
	                {bytes, static_cast<int>(grid.getSizeX()), static_cast<int>(grid.getSizeY()), static_cast<double>(grid.getXMin()),
	                 static_cast<double>(grid.getYMin()), static_cast<double>(grid.getResolution())},
	                poses);
}
}  // namespace viwo::gt
