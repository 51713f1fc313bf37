#pragma once

#include <mrpt/obs/CObservation.h>
#include <viwo/core/Trajectory.h>
#include <viwo/mapping/GroundFilter.h>
#include <viwo/mapping/RayScan.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>

namespace viwo
{
/** Which returns of which observations become rays. */
struct RayOptions
{
	bool scans = true;                                          //!< CObservation2DRangeScan
	bool depth = true;                                          //!< CObservation3DRangeScan
	bool clouds = true;                                         //!< CObservationPointCloud, CObservationVelodyneScan
	double min_range_m = 0;                                     //!< nearer returns are left out (the robot itself)
	int subsample = 1;                                          //!< of the returns of an observation, only every n-th
	double scan_duration_s = 0;                                 //!< of a planar scan, from the first to the last beam; 0: all at once
	double stamp_position = 0;                                  //!< where in that sweep its stamp lies: 0 first beam, 1 last
	double max_gap_s = 1;                                       //!< longest gap of the trajectory to interpolate across
	double min_z_m = -std::numeric_limits<double>::infinity();  //!< in the map; returns below are left out
	double max_z_m = std::numeric_limits<double>::infinity();
	std::optional<GroundFilter> ground;  //!< of depth images and clouds: the ground is seen through, not occupied
	bool colours = false;                //!< take the colours of returns along, where there are any
};

/** Observations to rays in the map, from where the sensor was by the trajectory: at the time of each beam where that is known (Velodyne;
 *  planar scans by scan_duration_s), at the stamp otherwise.
 */
class ObservationRays
{
   public:
	enum class Outcome
	{
		used,
		not_a_source,  //!< another class, or one that is not asked for
		no_pose,       //!< outside of the trajectory, or in a gap of it
		empty          //!< no return at all
	};

	/** @param trajectory of O; must outlive this object. */
	ObservationRays(const Trajectory& trajectory, const RayOptions& options);

	bool isSource(const mrpt::obs::CObservation& observation) const;
	/** By the class's name without namespace. */
	bool isSourceClass(const std::string& name) const;

	/** @throws Error when the observation's external file is missing. */
	Outcome convert(const mrpt::obs::CObservation::Ptr& observation, RayScan& rays) const;

   private:
	const Trajectory& trajectory_;
	RayOptions options_;
};
}  // namespace viwo
