#pragma once

#include <viwo/core/Pose3.h>
#include <viwo/sim/GreyImage.h>
#include <viwo/sim/World.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "LensTable.h"
#include "SurfaceShading.h"
#include "SurfaceView.h"

namespace viwo::sim
{
/** Casts the rays of one frame at one moment: nearest surface of every pixel tile by tile, its radiance, then outlines again with 16 rays.
 */
class FrameCaster
{
   public:
	FrameCaster(const World& world, const CameraModel& camera);

	/** Adds `weight` times the radiance seen from T_WC. */
	void add(const Pose3& T_WC, float weight, RadianceImage& image);

   private:
	struct Candidate
	{
		uint32_t view;
		float min_q, max_q;
		bool covers_all;
	};
	void castTile(const LensTable::Tile& tile);
	void chooseCandidates(const LensTable::Tile& tile);
	void castPixels(const LensTable::Tile& tile, const std::vector<Candidate>& candidates);
	void markThin(const LensTable::Tile& tile, const SurfaceView& view);
	void markOutlines();
	void shadeTile(const LensTable::Tile& tile, size_t index, float weight, RadianceImage& image) const;
	float outlineRadiance(const LensTable::Tile& tile, size_t index, float x, float y) const;
	size_t pixelIndex(int x_px, int y_px) const
	{
		return static_cast<size_t>(y_px) * static_cast<size_t>(width_px_) + static_cast<size_t>(x_px);
	}

	int width_px_, height_px_;
	double focal_px_;
	std::vector<Surface> surfaces_;
	// Never change: copies share them.
	std::shared_ptr<const LensTable> lens_;
	std::shared_ptr<const SurfaceShading> shading_;

	std::vector<SurfaceView> views_;
	std::vector<Candidate> candidates_;  // of the tile at work
	std::vector<uint32_t> kept_views_;   // of all tiles, one after the other
	std::vector<size_t> kept_until_;
	std::array<float, LensTable::kTilePixels> best_q_;
	std::array<int32_t, LensTable::kTilePixels> best_view_;
	std::vector<int32_t> view_of_pixel_;  // -1: nothing there
	std::vector<uint8_t> is_outline_;
};
}  // namespace viwo::sim
