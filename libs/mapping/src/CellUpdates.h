#pragma once

#include "KeySetOfScan.h"

#include <octomap/OcTree.h>
#include <viwo/mapping/OctreeBuilder.h>

#include <cstdint>
#include <vector>

namespace viwo
{
/** A change of one voxel in one word: its place on the Morton curve, the scan's place in its batch, whether it was hit. Sorted as numbers,
 *  changes are in the order of the tree's depth-first walk, and those of one voxel in the order of the scans.
 */
using CellUpdate = uint64_t;

constexpr int kScanBits = 15;
constexpr int kMortonShift = kScanBits + 1;
constexpr size_t kMaxScansOfBatch = size_t{1} << kScanBits;

/** Every third bit, from the lowest. */
inline uint64_t spreadBits(uint64_t x)
{
	x = (x | x << 32) & 0x1f00000000ffffu;
	x = (x | x << 16) & 0x1f0000ff0000ffu;
	x = (x | x << 8) & 0x100f00f00f00f00fu;
	x = (x | x << 4) & 0x10c30c30c30c30c3u;
	return (x | x << 2) & 0x1249249249249249u;
}

/** x lowest, as OctoMap numbers children. */
inline uint64_t mortonOf(const octomap::OcTreeKey& key)
{
	return spreadBits(key[0]) | spreadBits(key[1]) << 1 | spreadBits(key[2]) << 2;
}

inline CellUpdate cellUpdate(const octomap::OcTreeKey& key, size_t scan, bool hit)
{
	return mortonOf(key) << kMortonShift | scan << 1 | (hit ? 1u : 0u);
}

inline bool isHit(CellUpdate update)
{
	return (update & 1) != 0;
}

/** Which of the eight children at this depth (0: of the root). */
inline unsigned childOf(CellUpdate update, unsigned depth)
{
	return static_cast<unsigned>(update >> (kMortonShift + 3 * (15 - static_cast<int>(depth)))) & 7u;
}

octomap::OcTreeKey keyOf(CellUpdate update);

/** What a thread keeps from scan to scan. */
struct CellScratch
{
	KeySetOfScan seen, seen_ends;
	octomap::KeyRay ray;
};

/** The voxels that one scan changes, each once: those hit, then those passed and not hit, as computeUpdate() of liboctomap finds them.
 *  @param geometry a tree of the right resolution; its content does not matter.
 *  @return rays that could not be used.
 */
size_t appendUpdates(const RayScan& scan, size_t scan_index, const octomap::OcTree& geometry, const RayCasting& options,
                     CellScratch& scratch, std::vector<CellUpdate>& updates);
}  // namespace viwo
