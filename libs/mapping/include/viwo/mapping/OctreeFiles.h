#pragma once

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <viwo/mapping/OccupancyImage.h>

#include <functional>
#include <optional>
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

/** Between which heights a map is looked at, m. Where neither is given: from 0.05 to 2, without floor and ceiling; but a flat map (occupied
 *  voxels within 0.3 m of height, as planar scans leave them, often at z = 0) as a whole. Where one is given, the other is that of these
 * two.
 */
struct HeightSlice
{
	static constexpr double kMin_z_m = 0.05, kMax_z_m = 2;

	std::optional<double> min_z_m, max_z_m;
};

/** Looking down between two heights: occupied where any voxel is, free where any is known and none occupied, unknown elsewhere. Equal
 *  heights: the layer of voxels there.
 *  @throws Error when nothing is known between those heights; it says where something is.
 */
template <class Tree>
OccupancyImage projection(const Tree& tree, const HeightSlice& slice);

/** The same of a file, .bt or .ot, of an OcTree or a ColorOcTree. @throws Error: unreadable, or another kind of tree. */
OccupancyImage loadProjection(const std::string& path, const HeightSlice& slice);

/** Tells which heights projection() looks at. */
template <class Tree>
std::function<bool(double z_m)> heightsShown(const Tree& tree, const HeightSlice& slice);

/** Colours every occupied leaf by its height: from blue at the lowest to red at the highest. */
void colourByHeight(octomap::ColorOcTree& tree);
}  // namespace viwo
