#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <viwo/core/Pose3.h>
#include <viwo/mapping/ObservationRays.h>

#include <vector>

namespace viwo
{
/** What a range sensor got back, in its own frame S. */
struct SensorReturns
{
	Pose3 T_OS;
	std::vector<Eigen::Vector3d> points_S;  //!< m
	std::vector<int64_t> t_ns;              //!< of each point; or empty: all at the stamp
	std::vector<RayColour> colours;         //!< of each point; or empty
};

/** @name Valid returns only. Every `options.subsample`-th is taken, counted before others are left out. @{ */
SensorReturns returnsOf(const mrpt::obs::CObservation2DRangeScan& scan, const RayOptions& options);
SensorReturns returnsOf(mrpt::obs::CObservation3DRangeScan& image, const RayOptions& options);
SensorReturns returnsOf(const mrpt::obs::CObservationPointCloud& cloud, const RayOptions& options);
SensorReturns returnsOf(mrpt::obs::CObservationVelodyneScan& scan, const RayOptions& options);
/** @} */
}  // namespace viwo
