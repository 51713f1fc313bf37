#pragma once

#include <viwo/core/CameraModel.h>

#include <vector>

namespace viwo::sim
{
/** Rays of all pixels on the normalised plane (x/z, y/z), in square tiles: every pixel of a tile is a neighbour in memory. */
class LensTable
{
   public:
	static constexpr int kTile_px = 16;
	static constexpr size_t kTilePixels = static_cast<size_t>(kTile_px) * kTile_px;

	struct Tile
	{
		int x_px, y_px;                        // of the first pixel
		int columns, rows;                     // inside of the image
		float low_x, high_x, low_y, high_y;    // bounds of its pixels' areas on the normalised plane
		float x_px_x, x_px_y, y_px_x, y_px_y;  // movement on the normalised plane for one pixel to the right (x_px_) and down (y_px_)
		size_t first;                          // of its kTilePixels entries in x() and y()
	};

	/** @throws Error when a pixel looks more than 86 deg off the axis. */
	explicit LensTable(const CameraModel& camera);

	const std::vector<Tile>& tiles() const { return tiles_; }
	const float* x() const { return x_.data(); }
	const float* y() const { return y_.data(); }

   private:
	void addTile(const CameraModel& camera, int x_px, int y_px);

	std::vector<Tile> tiles_;
	std::vector<float> x_, y_;
};
}  // namespace viwo::sim
