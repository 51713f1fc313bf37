#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>
#include <viwo/mapping/OctreeFiles.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <type_traits>

#include "OctreeCheck.h"

namespace viwo
{
namespace
{
constexpr int kCentreKey = 32768;  //!< of the voxel that begins at 0 m

/** A leaf's voxels: [first, first + size) in each direction, 0 at the map's origin. */
struct LeafExtent
{
	int first[3];
	int size;
};

template <class Iterator>
LeafExtent extentOf(const Iterator& leaf, unsigned tree_depth)
{
	const octomap::OcTreeKey key = leaf.getIndexKey();
	return {{key[0] - kCentreKey, key[1] - kCentreKey, key[2] - kCentreKey}, 1 << (tree_depth - leaf.getDepth())};
}

template <class Value>
void putLittleEndian(std::string& bytes, Value value)
{
	uint32_t word = 0;
	std::memcpy(&word, &value, sizeof value);
	for (size_t i = 0; i < sizeof value; ++i) bytes += static_cast<char>(word >> (8 * i) & 0xffu);
}

void putColour(std::string&, const octomap::OcTreeNode&) {}
void putColour(std::string& bytes, const octomap::ColorOcTreeNode& node)
{
	const auto c = node.getColor();
	for (const uint8_t part : {c.r, c.g, c.b}) bytes += static_cast<char>(part);
}

template <class Tree>
constexpr bool kHasColour = std::is_same_v<Tree, octomap::ColorOcTree>;

/** Layers of voxels, both ends included. */
struct Layers
{
	int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
};

constexpr Layers kAllLayers{-kCentreKey, kCentreKey - 1};

/** All leaves that reach into the layers. */
template <class Tree, class Visit>
void visitLayers(const Tree& tree, const Layers& layers, const Visit& visit)
{
	for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
	{
		const LeafExtent extent = extentOf(leaf, tree.getTreeDepth());
		if (extent.first[2] <= layers.last && extent.first[2] + extent.size > layers.first) visit(extent, tree.isNodeOccupied(*leaf));
	}
}

/** From the lowest to the highest voxel. */
template <class Tree>
Layers knownLayers(const Tree& tree, bool occupied_only)
{
	Layers found;
	visitLayers(tree, kAllLayers,
	            [&](const LeafExtent& e, bool occupied)
	            {
		            if (occupied_only && !occupied) return;
		            found.first = std::min(found.first, e.first[2]);
		            found.last = std::max(found.last, e.first[2] + e.size - 1);
	            });
	return found;
}

int layerAt(double layers)
{
	return static_cast<int>(std::clamp(std::floor(layers), -1.0 * kCentreKey, kCentreKey - 1.0));
}

Layers layersOf(const HeightSlice& slice, double resolution_m)
{
	Layers layers;
	layers.first = layerAt(slice.min_z_m.value_or(HeightSlice::kMin_z_m) / resolution_m + 1e-9);
	layers.last = std::max(layers.first, layerAt(slice.max_z_m.value_or(HeightSlice::kMax_z_m) / resolution_m - 1e-9));
	return layers;
}

template <class Tree>
bool isFlat(const Tree& tree)
{
	constexpr double kFlat_m = 0.3;
	const Layers occupied = knownLayers(tree, true);
	return occupied.first <= occupied.last && (occupied.last - occupied.first) * tree.getResolution() < kFlat_m;
}

template <class Tree>
Layers layersOf(const Tree& tree, const HeightSlice& slice)
{
	return !slice.min_z_m && !slice.max_z_m && isFlat(tree) ? kAllLayers : layersOf(slice, tree.getResolution());
}

template <class Tree>
std::string nothingKnown(const Tree& tree, const Layers& asked)
{
	const auto between = [&](const Layers& layers)
	{ return fixed(layers.first * tree.getResolution(), 2) + " and " + fixed((layers.last + 1) * tree.getResolution(), 2) + " m"; };
	const Layers known = knownLayers(tree, false);
	if (known.first > known.last) return "the octree is empty";
	return "nothing is known between the heights " + between(asked) + ": the map lies between " + between(known);
}

// liboctomap's own functions for whole files print remarks on stderr, so the headers are written and read here.
constexpr const char* kHeaders[] = {"# Octomap OcTree file", "# Octomap OcTree binary file"};

struct OctreeHeader
{
	OctreeFormat format = OctreeFormat::ot;
	std::string id;
	double resolution_m = 0;
};

/** Up to the data. Nothing where it is no such file. */
std::optional<OctreeHeader> readHeader(std::istream& file)
{
	std::string line;
	if (!std::getline(file, line)) return std::nullopt;
	OctreeHeader header;
	if (line.rfind(kHeaders[1], 0) == 0)
		header.format = OctreeFormat::bt;
	else if (line.rfind(kHeaders[0], 0) != 0)
		return std::nullopt;
	while (std::getline(file, line))
	{
		std::istringstream words(line);
		std::string word;
		words >> word;
		if (word == "id") words >> header.id;
		if (word == "res") words >> header.resolution_m;
		if (word == "data") return header.resolution_m > 0 ? std::optional(header) : std::nullopt;
	}
	return std::nullopt;
}

template <class Tree>
std::optional<OccupancyImage> readProjection(std::istream& file, const OctreeHeader& header, const HeightSlice& slice)
{
	constexpr size_t kLogOdds = sizeof(float), kColour = 3;
	if (!isWholeOctree(file, header.format, kLogOdds + (kHasColour<Tree> ? kColour : 0))) return std::nullopt;
	Tree tree(header.resolution_m);
	if (header.format == OctreeFormat::bt)
		tree.readBinaryData(file);
	else
		tree.readData(file);
	if (!file) return std::nullopt;
	return projection(tree, slice);
}
}  // namespace

OctreeFormat octreeFormatOf(const std::string& path)
{
	const std::string extension = std::filesystem::path(path).extension().string();
	if (extension == ".ot") return OctreeFormat::ot;
	if (extension == ".bt") return OctreeFormat::bt;
	throw Error(path + ": an OctoMap's name ends in .bt or .ot");
}

template <class Tree>
void writeOctree(std::ostream& out, Tree& tree, OctreeFormat format)
{
	if (format == OctreeFormat::bt)
	{
		tree.toMaxLikelihood();
		tree.prune();
	}
	out << kHeaders[format == OctreeFormat::bt ? 1 : 0]
	    << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid " << tree.getTreeType() << "\nsize "
	    << tree.size() << "\nres " << tree.getResolution() << "\ndata\n";
	if (format == OctreeFormat::bt)
		tree.writeBinaryData(out);
	else
		tree.writeData(out);
}

template <class Tree>
void writeOccupiedPly(std::ostream& out, const Tree& tree)
{
	size_t count = 0;
	std::string bytes;
	const double resolution_m = tree.getResolution();
	for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
	{
		if (!tree.isNodeOccupied(*leaf)) continue;
		const LeafExtent e = extentOf(leaf, tree.getTreeDepth());
		for (int i = 0; i < e.size * e.size * e.size; ++i)
		{
			const int at[] = {e.first[0] + i % e.size, e.first[1] + i / e.size % e.size, e.first[2] + i / (e.size * e.size)};
			for (const int k : at) putLittleEndian(bytes, static_cast<float>((k + 0.5) * resolution_m));
			putColour(bytes, *leaf);
			++count;
		}
	}
	out << "ply\nformat binary_little_endian 1.0\ncomment centres of occupied voxels of " << resolution_m
	    << " m, in the map, m\nelement vertex " << count << "\nproperty float x\nproperty float y\nproperty float z\n"
	    << (kHasColour<Tree> ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "") << "end_header\n"
	    << bytes;
}

template <class Tree>
std::function<bool(double z_m)> heightsShown(const Tree& tree, const HeightSlice& slice)
{
	return [layers = layersOf(tree, slice), resolution_m = tree.getResolution()](double z_m)
	{
		const int layer = layerAt(z_m / resolution_m);
		return layer >= layers.first && layer <= layers.last;
	};
}

template <class Tree>
OccupancyImage projection(const Tree& tree, const HeightSlice& slice)
{
	const double resolution_m = tree.getResolution();
	const Layers layers = layersOf(tree, slice);
	int min[] = {kCentreKey, kCentreKey}, max[] = {-kCentreKey, -kCentreKey};
	visitLayers(tree, layers,
	            [&](const LeafExtent& e, bool)
	            {
		            for (size_t i = 0; i < 2; ++i)
		            {
			            min[i] = std::min(min[i], e.first[i]);
			            max[i] = std::max(max[i], e.first[i] + e.size);
		            }
	            });
	if (max[0] <= min[0]) throw Error(nothingKnown(tree, layers));
	OccupancyImage image;
	image.columns = max[0] - min[0];
	image.rows = max[1] - min[1];
	image.min_x_m = min[0] * resolution_m;
	image.min_y_m = min[1] * resolution_m;
	image.resolution_m = resolution_m;
	image.cells.assign(static_cast<size_t>(image.columns) * static_cast<size_t>(image.rows), OccupancyImage::kUnknown);
	visitLayers(tree, layers,
	            [&](const LeafExtent& e, bool occupied)
	            {
		            for (int y = e.first[1] - min[1]; y < e.first[1] - min[1] + e.size; ++y)
			            for (int x = e.first[0] - min[0]; x < e.first[0] - min[0] + e.size; ++x)
			            {
				            uint8_t& cell = image.cell(x, y);
				            if (occupied)
					            cell = OccupancyImage::kOccupied;
				            else if (cell == OccupancyImage::kUnknown)
					            cell = OccupancyImage::kFree;
			            }
	            });
	return image;
}

OccupancyImage loadProjection(const std::string& path, const HeightSlice& slice)
{
	std::ifstream file(path, std::ios::binary);
	if (!file) throw Error(path + ": cannot read this octree; check its name");
	std::optional<OccupancyImage> image;
	try
	{
		const std::optional<OctreeHeader> header = readHeader(file);
		if (header && header->id == "OcTree") image = readProjection<octomap::OcTree>(file, *header, slice);
		if (header && header->id == "ColorOcTree") image = readProjection<octomap::ColorOcTree>(file, *header, slice);
	}
	catch (const Error& e)
	{
		throw Error(path + ": " + e.what());
	}
	if (image) return *image;
	throw Error(path + ": not an OctoMap file (OcTree or ColorOcTree), or cut short or damaged; write or copy it again");
}

void colourByHeight(octomap::ColorOcTree& tree)
{
	double low = std::numeric_limits<double>::infinity(), high = -low;
	for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
	{
		if (!tree.isNodeOccupied(*leaf)) continue;
		low = std::min(low, leaf.getZ());
		high = std::max(high, leaf.getZ());
	}
	for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
	{
		if (!tree.isNodeOccupied(*leaf)) continue;
		// Blue, cyan, green, yellow, red: a quarter of the way each.
		const double h = high > low ? 4 * (leaf.getZ() - low) / (high - low) : 0;
		const auto part = [&](double centre, double flat)
		{ return static_cast<uint8_t>(std::lround(255 * std::clamp(flat + 1 - std::abs(h - centre), 0.0, 1.0))); };
		leaf->setColor(part(4, 1), part(2, 1), part(0, 1));
	}
	tree.updateInnerOccupancy();
}

template void writeOctree(std::ostream&, octomap::OcTree&, OctreeFormat);
template void writeOctree(std::ostream&, octomap::ColorOcTree&, OctreeFormat);
template void writeOccupiedPly(std::ostream&, const octomap::OcTree&);
template void writeOccupiedPly(std::ostream&, const octomap::ColorOcTree&);
template std::function<bool(double)> heightsShown(const octomap::OcTree&, const HeightSlice&);
template std::function<bool(double)> heightsShown(const octomap::ColorOcTree&, const HeightSlice&);
template OccupancyImage projection(const octomap::OcTree&, const HeightSlice&);
template OccupancyImage projection(const octomap::ColorOcTree&, const HeightSlice&);
}  // namespace viwo
