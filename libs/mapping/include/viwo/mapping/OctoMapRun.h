#pragma once

#include <viwo/mapping/ObservationRays.h>
#include <viwo/mapping/OctreeBuilder.h>
#include <viwo/mapping/OctreeFiles.h>

#include <functional>
#include <string>
#include <vector>

namespace viwo
{
enum class VoxelColours
{
	none,
	sensor,  //!< of the returns, where they have any
	height
};

/** What is made into an octree, and how. */
struct OctoMapRunOptions
{
	std::string rawlog, trajectory;  //!< the trajectory is of O, TUM
	std::string output;              //!< .bt or .ot
	bool both = false;               //!< the other of these two as well
	std::string scan_graph;          //!< text for octomap's log2graph; empty: none
	std::string ply;                 //!< occupied voxels; empty: none
	std::string grid;                //!< map_server's YAML; empty: none
	HeightSlice grid_slice;
	std::string flags;  //!< trajectory_covariance.csv; empty: all poses are good
	std::vector<std::string> bad_flags = {"odometry_only"};
	std::string landmarks_dir;  //!< output of viwo-odometry; empty: none
	double max_landmark_deviation = 0.05;
	double resolution_m = 0.05;
	SensorModel model;
	RayCasting casting;
	RayOptions rays;
	VoxelColours colours = VoxelColours::none;
	int threads = 1;
	bool allow_truncated = false;
};

/** Hooks of a run; all may be empty. */
struct OctoMapRunHooks
{
	std::function<void(double fraction, const std::string& note)> progress;
	std::function<bool()> interrupted;
};

/** What became of the observations. */
struct OctoMapRunResult
{
	size_t used = 0;     //!< observations in the map, key frames with landmarks included
	size_t flagged = 0;  //!< left out: pose flagged as bad
	size_t no_pose = 0;  //!< left out: not on the trajectory
	size_t no_time = 0;  //!< left out: no stamp, too late, or far from all others
	size_t empty = 0;    //!< without any return
	size_t rays = 0, unusable_rays = 0;
	size_t scans_off_grid = 0;      //!< planar scans whose sensor lies outside of the grid's heights; 0 without a grid
	size_t occupied = 0, free = 0;  //!< leaves
	double wall_time_s = 0;
};

/** Rawlog and trajectory to an OctoMap. Files appear when they are whole; the same input gives the same bytes, whatever the number of
 *  threads. Memory is that of the map.
 *  @throws Error with one line for the user; where the grid alone cannot be made, when all else has been written.
 */
OctoMapRunResult runOctoMap(const OctoMapRunOptions& options, const OctoMapRunHooks& hooks = {});
}  // namespace viwo
