#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/mapping/OccupancyImage.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "CommitTogether.h"

namespace viwo
{
namespace
{
constexpr float kOccupiedBelow = 0.35f, kFreeAbove = 0.65f;  // of MRPT's cells, which hold the probability of being free
constexpr const char* kPlainCharacters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-";  // need no quotes in YAML
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

OccupancyImage coarser(const OccupancyImage& map, int factor)
{
	OccupancyImage result = map;
	result.columns = (map.columns + factor - 1) / factor;
	result.rows = (map.rows + factor - 1) / factor;
	result.resolution_m = factor * map.resolution_m;
	result.cells.assign(static_cast<size_t>(result.columns) * static_cast<size_t>(result.rows), OccupancyImage::kUnknown);
	for (int y = 0; y < map.rows; ++y)
		for (int x = 0; x < map.columns; ++x)
		{
			uint8_t& cell = result.cell(x / factor, y / factor);
			const uint8_t part = map.cell(x, y);
			if (part == OccupancyImage::kOccupied || (part == OccupancyImage::kFree && cell == OccupancyImage::kUnknown)) cell = part;
		}
	return result;
}

void saveMapServer(const std::string& yaml_path, const OccupancyImage& image)
{
	const std::filesystem::path pgm_path = std::filesystem::path(yaml_path).replace_extension(".pgm");
	AtomicFile pgm(pgm_path.string());
	pgm.stream() << "P5\n" << image.columns << " " << image.rows << "\n255\n";
	pgm.stream().write(reinterpret_cast<const char*>(image.cells.data()), static_cast<std::streamsize>(image.cells.size()));
	const std::string keys =
	    mrpt::format("mode: trinary\nresolution: %.6f\norigin: [%.6f, %.6f, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
	                 image.resolution_m, image.min_x_m, image.min_y_m);
	AtomicFile yaml(yaml_path);
	const std::string name = pgm_path.filename().string();
	const bool plain = name.find_first_not_of(kPlainCharacters) == std::string::npos;
	yaml.stream() << "image: " << (plain ? name : "\"" + name + "\"") << "\n" << keys;
	commitTogether({&pgm, &yaml});
}

namespace
{
/** Without blanks and quotes around it. */
std::string trimmed(const std::string& text)
{
	constexpr const char* kAround = " \t\r\"'";
	const size_t first = text.find_first_not_of(kAround);
	return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(kAround) + 1 - first);
}

/** `key: value` lines; enough for what map_server reads. */
std::map<std::string, std::string> readKeys(const std::string& path)
{
	std::ifstream file(path);
	if (!file) throw Error(path + ": cannot read this map; check its name");
	std::map<std::string, std::string> keys;
	for (std::string line; std::getline(file, line);)
	{
		const size_t colon = line.find(':');
		if (colon == std::string::npos || line[0] == '#') continue;
		keys[line.substr(0, colon)] = trimmed(line.substr(colon + 1, line.find(" #", colon) - colon - 1));
	}
	return keys;
}

std::vector<double> numbers(const std::map<std::string, std::string>& keys, const std::string& key, size_t count, const std::string& path)
{
	const auto at = keys.find(key);
	std::vector<double> values;
	if (at != keys.end())
	{
		std::string text = at->second;
		for (char& c : text)
			if (c == '[' || c == ']' || c == ',') c = ' ';
		std::istringstream words(text);
		for (double value = 0; words >> value;) values.push_back(value);
	}
	if (values.size() != count) throw Error(path + ": key '" + key + "' must have " + std::to_string(count) + " number(s)");
	return values;
}

void readPgm(const std::string& path, OccupancyImage& image)
{
	std::ifstream file(path, std::ios::binary);
	if (!file) throw Error(path + ": cannot read the map's image");
	std::string magic;
	file >> magic;
	while ((file >> std::ws).peek() == '#') file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
	int most = 0;
	file >> image.columns >> image.rows >> most;
	if (!file || magic != "P5" || image.columns <= 0 || image.rows <= 0 || most != 255) throw Error(path + ": not a binary PGM of 8 bits");
	file.get();
	// Before memory is asked for: the header may promise anything.
	const std::uintmax_t bytes = static_cast<std::uintmax_t>(image.columns) * static_cast<std::uintmax_t>(image.rows);
	if (bytes > std::filesystem::file_size(path)) throw Error(path + ": the image ends too early");
	image.cells.resize(static_cast<size_t>(image.columns) * static_cast<size_t>(image.rows));
	if (!file.read(reinterpret_cast<char*>(image.cells.data()), static_cast<std::streamsize>(image.cells.size())))
		throw Error(path + ": the image ends too early");
}
}  // namespace

OccupancyImage loadMapServer(const std::string& yaml_path)
{
	const auto keys = readKeys(yaml_path);
	OccupancyImage image;
	image.resolution_m = numbers(keys, "resolution", 1, yaml_path)[0];
	const std::vector<double> origin = numbers(keys, "origin", 3, yaml_path);
	const double occupied = numbers(keys, "occupied_thresh", 1, yaml_path)[0], free = numbers(keys, "free_thresh", 1, yaml_path)[0];
	const bool negate = numbers(keys, "negate", 1, yaml_path)[0] != 0;
	if (!(image.resolution_m > 0)) throw Error(yaml_path + ": key 'resolution' must be above 0");
	if (origin[2] != 0) throw Error(yaml_path + ": key 'origin': a map that is turned cannot be read");
	for (const double value : origin)
		if (std::abs(value) > 1e8) throw Error(yaml_path + ": key 'origin' is out of all reason");
	image.min_x_m = origin[0];
	image.min_y_m = origin[1];
	const std::string file = keys.count("image") ? keys.at("image") : std::string();
	if (file.empty()) throw Error(yaml_path + ": there is no key 'image'");
	readPgm((std::filesystem::path(yaml_path).parent_path() / file).string(), image);
	for (uint8_t& cell : image.cells)
	{
		const double p = (negate ? cell : 255 - cell) / 255.0;
		cell = p > occupied ? OccupancyImage::kOccupied : p < free ? OccupancyImage::kFree : OccupancyImage::kUnknown;
	}
	return image;
}
}  // namespace viwo
