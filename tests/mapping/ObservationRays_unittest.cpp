#include "ExpectError.h"
#include "TempFolder.h"

#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <viwo/core/MrptPose.h>
#include <viwo/mapping/ObservationRays.h>
#include <viwo/rawlog/MrptTime.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace viwo
{
namespace
{
using namespace mrpt::obs;
using Outcome = ObservationRays::Outcome;

constexpr int64_t kStart_ns = 1'700'000'000'000'000'000;

/** 1 m/s along x from (10, 20, 0), heading along y. */
Trajectory drive()
{
	const Eigen::Quaterniond left(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
	Trajectory trajectory;
	for (int i = 0; i <= 10; ++i) trajectory.push_back({kStart_ns + i * 100'000'000, Pose3(left, {10 + 0.1 * i, 20, 0})});
	return trajectory;
}

mrpt::poses::CPose3D mount()
{
	return mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0, 0, 0);
}

RayScan raysOf(const CObservation::Ptr& observation, double t_s, const RayOptions& options = {})
{
	observation->timestamp = mrptTime(kStart_ns + static_cast<int64_t>(t_s * 1e9));
	static Trajectory trajectory = drive();
	RayScan rays;
	EXPECT_EQ(ObservationRays(trajectory, options).convert(observation, rays), Outcome::used);
	return rays;
}

void expectNear(const octomap::point3d& p, double x, double y, double z, double within_m = 1e-4)
{
	EXPECT_LT((p - octomap::point3d(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z))).norm(), within_m) << p;
}

CObservation2DRangeScan::Ptr scanOf(const std::vector<float>& ranges)
{
	auto scan = CObservation2DRangeScan::Create();
	scan->aperture = static_cast<float>(M_PI);
	scan->maxRange = 30;
	scan->sensorPose = mount();
	scan->resizeScan(ranges.size());
	for (size_t i = 0; i < ranges.size(); ++i)
	{
		scan->setScanRange(i, ranges[i]);
		scan->setScanRangeValidity(i, ranges[i] > 0);
	}
	return scan;
}
}  // namespace

TEST(ObservationRays, PlanarScan)
{
	// Right, ahead, left in the sensor; the vehicle heads along y.
	const RayScan rays = raysOf(scanOf({1, 2, 3}), 0.5);
	ASSERT_EQ(rays.hits.size(), 3u);
	for (const Ray& ray : rays.hits) expectNear(ray.origin, 10.5 - 0.2, 20.1, 0.3);
	expectNear(rays.hits[0].end, 10.3 + 1, 20.1, 0.3);
	expectNear(rays.hits[1].end, 10.3, 22.1, 0.3);
	expectNear(rays.hits[2].end, 10.3 - 3, 20.1, 0.3);

	auto mirrored = scanOf({1, 2, 3});
	mirrored->rightToLeft = false;
	expectNear(raysOf(mirrored, 0.5).hits[0].end, 10.3 - 1, 20.1, 0.3);
	EXPECT_EQ(raysOf(scanOf({1, 0, std::numeric_limits<float>::quiet_NaN()}), 0.5).hits.size(), 1u) << "no return, no ray";
}

TEST(ObservationRays, EachBeamFromWhereTheSensorWas)
{
	RayOptions options;
	options.scan_duration_s = 0.2;
	options.stamp_position = 0.5;
	const RayScan rays = raysOf(scanOf({1, 1, 1}), 0.5, options);
	expectNear(rays.hits[0].origin, 10.4 - 0.2, 20.1, 0.3);
	expectNear(rays.hits[1].origin, 10.5 - 0.2, 20.1, 0.3);
	expectNear(rays.hits[2].origin, 10.6 - 0.2, 20.1, 0.3);
	expectNear(rays.hits[2].end, 10.6 - 1.2, 20.1, 0.3);
	// Beams beyond the trajectory's end are cast from the pose at the stamp.
	expectNear(raysOf(scanOf({1, 1, 1}), 0.95, options).hits[2].origin, 10.95 - 0.2, 20.1, 0.3);
}

TEST(ObservationRays, LimitsAndSubsampling)
{
	RayOptions options;
	options.min_range_m = 1.5;
	EXPECT_EQ(raysOf(scanOf({1, 2, 3}), 0.5, options).hits.size(), 2u);
	options = {};
	options.subsample = 2;
	EXPECT_EQ(raysOf(scanOf({1, 2, 3, 4, 5}), 0.5, options).hits.size(), 3u);
	auto tilted = scanOf({1, 2, 3});
	tilted->sensorPose = mrpt::poses::CPose3D(0, 0, 1, 0, -M_PI / 6, 0);
	options = {};
	options.max_z_m = 1.5;
	EXPECT_EQ(raysOf(tilted, 0.5, options).hits.size(), 2u) << "the middle beam goes up to 2 m";
}

TEST(ObservationRays, DepthImage)
{
	auto image = CObservation3DRangeScan::Create();
	image->sensorPose = mount();
	image->hasRangeImage = true;
	image->range_is_depth = true;
	image->rangeUnits = 0.001f;
	image->rangeImage_setSize(4, 6);
	image->rangeImage.fill(0);
	image->rangeImage(1, 2) = 2000;  // row, column
	image->rangeImage(3, 5) = 1000;
	image->cameraParams.nrows = 4;
	image->cameraParams.ncols = 6;
	image->cameraParams.setIntrinsicParamsFromValues(4, 4, 2, 1);
	RayScan rays = raysOf(image, 0.5);
	ASSERT_EQ(rays.hits.size(), 2u);
	// x ahead = depth, y left = (cx - column) / fx depth, z up = (cy - row) / fy depth; the vehicle heads along the map's y.
	expectNear(rays.hits[0].end, 10.5 - 0.2, 20.1 + 2, 0.3);
	expectNear(rays.hits[1].end, 10.5 - 0.2 + 0.75, 20.1 + 1, 0.3 - 0.5);
	expectNear(rays.hits[1].origin, 10.3, 20.1, 0.3);

	image->hasIntensityImage = true;
	image->intensityImage = mrpt::img::CImage(6, 4, mrpt::img::CH_RGB);
	for (int column = 0; column < 6; ++column)
		for (int row = 0; row < 4; ++row) image->intensityImage.setPixel(column, row, mrpt::img::TColor(10, 200, 30));
	image->cameraParamsIntensity = image->cameraParams;
	image->relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
	RayOptions options;
	options.colours = true;
	rays = raysOf(image, 0.5, options);
	ASSERT_EQ(rays.colours.size(), 2u);
	EXPECT_EQ(rays.colours[0], (RayColour{10, 200, 30}));
}

TEST(ObservationRays, PointCloudWithColours)
{
	auto map = mrpt::maps::CColouredPointsMap::Create();
	map->insertPointRGB(1, 0, 0, 1, 0, 0);
	map->insertPointRGB(0, 2, 0, 0, 0, 1);
	auto cloud = CObservationPointCloud::Create();
	cloud->pointcloud = map;
	cloud->sensorPose = mount();
	RayOptions options;
	options.colours = true;
	const RayScan rays = raysOf(cloud, 0.5, options);
	ASSERT_EQ(rays.hits.size(), 2u);
	expectNear(rays.hits[0].end, 10.3, 21.1, 0.3);
	expectNear(rays.hits[1].end, 10.3 - 2, 20.1, 0.3);
	EXPECT_EQ(rays.colours[0], (RayColour{255, 0, 0}));
	EXPECT_EQ(rays.colours[1], (RayColour{0, 0, 255}));
	EXPECT_TRUE(raysOf(cloud, 0.5).colours.empty());
}

TEST(ObservationRays, VelodynePointsHaveTimesOfTheirOwn)
{
	auto scan = CObservationVelodyneScan::Create();
	scan->sensorPose = mount();
	auto& points = scan->point_cloud;
	points.x = {1, 1};
	points.y = {0, 0};
	points.z = {0, 0};
	points.intensity = {7, 8};
	points.timestamp = {mrptTime(kStart_ns + 450'000'000), mrptTime(kStart_ns + 550'000'000)};
	const RayScan rays = raysOf(scan, 0.5);
	ASSERT_EQ(rays.hits.size(), 2u);
	expectNear(rays.hits[0].origin, 10.45 - 0.2, 20.1, 0.3);
	expectNear(rays.hits[1].origin, 10.55 - 0.2, 20.1, 0.3);
	expectNear(rays.hits[1].end, 10.55 - 0.2, 21.1, 0.3);
}

TEST(ObservationRays, TheGroundIsSeenThrough)
{
	std::mt19937_64 random(3);
	std::uniform_real_distribution<float> any(-1, 1);
	auto map = mrpt::maps::CSimplePointsMap::Create();
	// A floor that slopes a little below the sensor, and a wall behind it.
	for (int i = 0; i < 500; ++i)
	{
		const float x = 3 + 2 * any(random);
		map->insertPoint(x, 2 * any(random), -0.3f + 0.02f * (x - 3) + 0.01f * any(random));
	}
	for (int i = 0; i < 200; ++i) map->insertPoint(6, 2 * any(random), 0.7f + 0.6f * any(random));
	auto cloud = CObservationPointCloud::Create();
	cloud->pointcloud = map;
	cloud->sensorPose = mount();
	EXPECT_EQ(raysOf(cloud, 0.5).hits.size(), 700u);
	RayOptions options;
	options.ground.emplace();
	const RayScan rays = raysOf(cloud, 0.5, options);
	EXPECT_EQ(rays.hits.size(), 200u);
	EXPECT_EQ(rays.clearing.size(), 500u);
	// A tilted plane is no ground.
	options.ground->angle_rad = 0.001;
	options.ground->plane_distance_m = 1e-6;
	EXPECT_EQ(raysOf(cloud, 0.5, options).hits.size(), 700u);
}

TEST(ObservationRays, WhatIsNoSource)
{
	const Trajectory trajectory = drive();
	RayScan rays;
	RayOptions options;
	options.scans = false;
	auto imu = CObservationIMU::Create();
	EXPECT_EQ(ObservationRays(trajectory, {}).convert(imu, rays), Outcome::not_a_source);
	auto scan = scanOf({1, 2});
	scan->timestamp = mrptTime(kStart_ns);
	EXPECT_EQ(ObservationRays(trajectory, options).convert(scan, rays), Outcome::not_a_source);
	EXPECT_EQ(ObservationRays(trajectory, {}).convert(scan, rays), Outcome::used);
	scan->timestamp = mrptTime(kStart_ns - 1'000'000);
	EXPECT_EQ(ObservationRays(trajectory, {}).convert(scan, rays), Outcome::no_pose);
	options = {};
	options.max_gap_s = 0.05;
	scan->timestamp = mrptTime(kStart_ns + 30'000'000);
	EXPECT_EQ(ObservationRays(trajectory, options).convert(scan, rays), Outcome::no_pose);
	scan = scanOf({0, 0});
	scan->timestamp = mrptTime(kStart_ns);
	RayScan none;
	EXPECT_EQ(ObservationRays(trajectory, {}).convert(scan, none), Outcome::empty);
}
}  // namespace viwo
