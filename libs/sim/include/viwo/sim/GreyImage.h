#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace viwo::sim
{
/** An 8-bit image, row by row from the top left pixel. */
struct GreyImage
{
	int width_px = 0;
	int height_px = 0;
	std::vector<uint8_t> pixels;

	uint8_t at(int x_px, int y_px) const
	{
		return pixels[static_cast<size_t>(y_px) * static_cast<size_t>(width_px) + static_cast<size_t>(x_px)];
	}
};

/** Light on the sensor before any effect: 1 is a white wall at nominal illumination. Row by row from the top left pixel. */
struct RadianceImage
{
	int width_px = 0;
	int height_px = 0;
	std::vector<float> pixels;
};
}  // namespace viwo::sim
