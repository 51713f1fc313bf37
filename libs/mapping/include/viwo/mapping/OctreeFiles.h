#pragma once

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <viwo/mapping/OccupancyImage.h>

#include <ostream>
#include <string>

namespace viwo
{
enum class OctreeFormat
{
	ot,  //!< all of it: log-odds, colours
	bt   //!< free, occupied or unknown
};

/** By the name's extension. @throws Error for any but .ot and .bt. */
OctreeFormat octreeFormatOf(const std::string& path);

/** The file's content, as octomap-tools and MRPT's COctoMap (.bt) read it. The tree is left as the format keeps it: with `bt`, at the
 *  clamping limits and pruned.
 */
template <class Tree>
void writeOctree(std::ostream& out, Tree& tree, OctreeFormat format);

/** Centres of the occupied voxels, all of the tree's resolution, as PLY (binary, little endian): float x, y, z, m; of a ColorOcTree
 *  uchar red, green, blue too. In the order of the tree's depth-first walk.
 */
template <class Tree>
void writeOccupiedPly(std::ostream& out, const Tree& tree);

/** Looking down between two heights: occupied where any voxel is, free where any is known and none occupied, unknown elsewhere. Equal
 *  heights: the layer of voxels there.
 *  @throws Error when nothing is known between those heights.
 */
template <class Tree>
OccupancyImage projection(const Tree& tree, double min_z_m, double max_z_m);

/** The same of a file, .bt or .ot, of an OcTree or a ColorOcTree. @throws Error: unreadable, or another kind of tree. */
OccupancyImage loadProjection(const std::string& path, double min_z_m, double max_z_m);

/** Colours every occupied leaf by its height: from blue at the lowest to red at the highest. */
void colourByHeight(octomap::ColorOcTree& tree);
}  // namespace viwo
