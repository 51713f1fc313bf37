#include "SensorReturns.h"

#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>

#include <cmath>

namespace viwo
{
namespace
{
using namespace mrpt::obs;

uint8_t byteOf(float fraction)
{
	return static_cast<uint8_t>(std::lround(std::min(1.f, std::max(0.f, fraction)) * 255));
}

void appendPoints(const mrpt::maps::CPointsMap& points, const RayOptions& options, SensorReturns& returns)
{
	const auto* coloured = options.colours ? dynamic_cast<const mrpt::maps::CColouredPointsMap*>(&points) : nullptr;
	for (size_t i = 0; i < points.size(); i += static_cast<size_t>(options.subsample))
	{
		float x = 0, y = 0, z = 0, red = 0, green = 0, blue = 0;
		if (coloured)
			coloured->getPointRGB(i, x, y, z, red, green, blue);
		else
			points.getPointFast(i, x, y, z);
		const Eigen::Vector3d p(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
		if (!p.allFinite() || p.norm() <= options.min_range_m) continue;
		returns.points_S.push_back(p);
		if (coloured) returns.colours.push_back({byteOf(red), byteOf(green), byteOf(blue)});
	}
}
}  // namespace

SensorReturns returnsOf(const CObservation2DRangeScan& scan, const RayOptions& options)
{
	SensorReturns returns;
	returns.T_OS = fromMrpt(scan.sensorPose);
	const size_t n = scan.getScanSize();
	const double aperture = static_cast<double>(scan.aperture);
	const int64_t stamp_ns = nanosecondsOf(scan.timestamp);
	for (size_t i = 0; i < n; i += static_cast<size_t>(options.subsample))
	{
		const double range_m = static_cast<double>(scan.getScanRange(i));
		if (!scan.getScanRangeValidity(i) || !std::isfinite(range_m) || range_m <= options.min_range_m) continue;
		const double along = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0.5;
		const double angle = (along - 0.5) * aperture * (scan.rightToLeft ? 1 : -1);
		returns.points_S.emplace_back(range_m * std::cos(angle), range_m * std::sin(angle), 0);
		if (options.scan_duration_s > 0)
			returns.t_ns.push_back(stamp_ns + nanoseconds(options.scan_duration_s * (along - options.stamp_position)));
	}
	return returns;
}

SensorReturns returnsOf(CObservation3DRangeScan& image, const RayOptions& options)
{
	image.load();
	SensorReturns returns;
	returns.T_OS = fromMrpt(image.sensorPose);
	const bool coloured = options.colours && image.hasIntensityImage;
	std::unique_ptr<mrpt::maps::CPointsMap> points;
	if (image.hasRangeImage && coloured)
	{
		auto map = std::make_unique<mrpt::maps::CColouredPointsMap>();
		map->colorScheme.scheme = mrpt::maps::CColouredPointsMap::cmFromIntensityImage;
		image.unprojectInto(*map);
		points = std::move(map);
	}
	else if (image.hasRangeImage)
	{
		auto map = std::make_unique<mrpt::maps::CSimplePointsMap>();
		image.unprojectInto(*map);
		points = std::move(map);
	}
	else
	{
		points = std::make_unique<mrpt::maps::CSimplePointsMap>();
		if (image.hasPoints3D) points->setAllPoints(image.points3D_x, image.points3D_y, image.points3D_z);
	}
	appendPoints(*points, options, returns);
	image.unload();
	return returns;
}

SensorReturns returnsOf(const CObservationPointCloud& cloud, const RayOptions& options)
{
	cloud.load();
	SensorReturns returns;
	returns.T_OS = fromMrpt(cloud.sensorPose);
	if (cloud.pointcloud) appendPoints(*cloud.pointcloud, options, returns);
	cloud.unload();
	return returns;
}

SensorReturns returnsOf(CObservationVelodyneScan& scan, const RayOptions& options)
{
	SensorReturns returns;
	returns.T_OS = fromMrpt(scan.sensorPose);
	if (!scan.scan_packets.empty())
	{
		CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
		parameters.minDistance = static_cast<float>(options.min_range_m);
		parameters.generatePerPointTimestamp = true;
		scan.generatePointCloud(parameters);
	}
	const auto& cloud = scan.point_cloud;
	for (size_t i = 0; i < cloud.size(); i += static_cast<size_t>(options.subsample))
	{
		const Eigen::Vector3d p(static_cast<double>(cloud.x[i]), static_cast<double>(cloud.y[i]), static_cast<double>(cloud.z[i]));
		if (!p.allFinite() || p.norm() <= options.min_range_m) continue;
		returns.points_S.push_back(p);
		if (cloud.timestamp.size() == cloud.size()) returns.t_ns.push_back(nanosecondsOf(cloud.timestamp[i]));
		if (options.colours && cloud.intensity.size() == cloud.size())
			returns.colours.push_back({cloud.intensity[i], cloud.intensity[i], cloud.intensity[i]});
	}
	return returns;
}
}  // namespace viwo
