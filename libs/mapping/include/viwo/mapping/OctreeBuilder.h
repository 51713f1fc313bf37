#pragma once

#include <viwo/mapping/RayScan.h>

#include <cstddef>
#include <memory>

namespace viwo
{
/** How rays change what is known of a voxel: probabilities, with OctoMap's names and defaults. */
struct SensorModel
{
	double hit = 0.7;              //!< of being occupied, after one hit on an unknown voxel
	double miss = 0.4;             //!< of being occupied, after one ray through an unknown voxel
	double clamping_min = 0.1192;  //!< never surer than this that a voxel is free
	double clamping_max = 0.971;   //!< never surer than this that it is occupied
	double occupancy_threshold = 0.5;
};

/** How rays become voxels. */
struct RayCasting
{
	double max_range_m = -1;  //!< longer rays only clear, up to this; below 0: no limit
	bool discretize = false;  //!< one ray for each voxel that is hit in a scan, to its centre
};

/** Builds an octree out of scans: the same tree, to the bit, as that of calling insertPointCloud() of liboctomap scan by scan, in less
 * time.
 *
 *  A voxel is changed at most once by a scan, and being hit prevails over being passed. The cells of many scans are sorted (along a
 *  Morton curve, then by scan), so that the tree is walked once for all of them; the changes of each voxel are still made in the order of
 *  the scans. Cells of the next scans are computed meanwhile, by other threads. The tree does not depend on their number.
 *
 *  @tparam Tree octomap::OcTree or octomap::ColorOcTree
 */
template <class Tree>
class OctreeBuilder
{
   public:
	/** @throws Error when the model makes no sense (hit below 0.5, miss above, clamping the wrong way round). */
	OctreeBuilder(double resolution_m, const SensorModel& model, const RayCasting& rays, int threads);
	~OctreeBuilder();

	void add(RayScan scan);

	/** All that was added is in the tree. */
	void finish();

	/** Complete after finish(). */
	Tree& tree();

	/** Rays that were left out: an end that is not finite, outside of the octree, or too far off for it. */
	size_t unusableRays() const;

   private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
};
}  // namespace viwo
