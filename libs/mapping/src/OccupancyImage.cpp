#include <viwo/core/AtomicFile.h>
#include <viwo/mapping/OccupancyImage.h>

#include <cstdio>
#include <filesystem>

namespace viwo
{
namespace
{
constexpr float kOccupiedBelow = 0.35f, kFreeAbove = 0.65f;  // of MRPT's cells, which hold the probability of being free
}  // namespace

OccupancyImage occupancyImage(const mrpt::maps::COccupancyGridMap2D& grid)
{
	OccupancyImage image;
	image.columns = static_cast<int>(grid.getSizeX());
	image.rows = static_cast<int>(grid.getSizeY());
	image.min_x_m = static_cast<double>(grid.getXMin());
	image.min_y_m = static_cast<double>(grid.getYMin());
	image.resolution_m = static_cast<double>(grid.getResolution());
	image.cells.reserve(static_cast<size_t>(image.columns) * static_cast<size_t>(image.rows));
	for (int y = image.rows - 1; y >= 0; --y)
		for (int x = 0; x < image.columns; ++x)
		{
			const float free = grid.getCell(x, y);
			image.cells.push_back(free < kOccupiedBelow ? OccupancyImage::kOccupied
			                      : free > kFreeAbove   ? OccupancyImage::kFree
			                                            : OccupancyImage::kUnknown);
		}
	return image;
}

void saveMapServer(const std::string& yaml_path, const OccupancyImage& image)
{
	const std::filesystem::path pgm_path = std::filesystem::path(yaml_path).replace_extension(".pgm");
	AtomicFile pgm(pgm_path.string());
	pgm.stream() << "P5\n" << image.columns << " " << image.rows << "\n255\n";
	pgm.stream().write(reinterpret_cast<const char*>(image.cells.data()), static_cast<std::streamsize>(image.cells.size()));
	char text[512];
	std::snprintf(text, sizeof text,
	              "mode: trinary\nresolution: %.6f\norigin: [%.6f, %.6f, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
	              image.resolution_m, image.min_x_m, image.min_y_m);
	AtomicFile yaml(yaml_path);
	yaml.stream() << "image: " << pgm_path.filename().string() << "\n" << text;
	pgm.commit();
	yaml.commit();
}
}  // namespace viwo
