#pragma once

#include <memory>
#include <vector>

#include "Lighting.h"
#include "SurfaceView.h"
#include "Texture.h"

namespace viwo::sim
{
/** Textures and light of all surfaces of a world: what comes from a point of a surface towards the camera. */
class SurfaceShading
{
   public:
	explicit SurfaceShading(const World& world);

	/** Radiance along the ray through (x, y) of the normalised plane, averaged over one pixel of `tile`. */
	float radiance(const SurfaceView& view, float x, float y, const LensTable::Tile& tile) const
	{
		const Look& look = looks_[view.surface];
		const float z = 1 / view.q.at(x, y), u = view.uq.at(x, y) * z, v = view.vq.at(x, y) * z;
		const float light = look.emission > 0 ? look.emission : lighting_.at(view.surface, u, v);
		if (look.texture == nullptr) return light * look.albedo;
		// d(u)/dx = (d(uq)/dx - u dq/dx) / q, from there to pixels with the lens.
		const float u_dx = (view.uq.x - u * view.q.x) * z, u_dy = (view.uq.y - u * view.q.y) * z;
		const float v_dx = (view.vq.x - v * view.q.x) * z, v_dy = (view.vq.y - v * view.q.y) * z;
		const Footprint footprint{u_dx * tile.x_px_x + u_dy * tile.x_px_y, v_dx * tile.x_px_x + v_dy * tile.x_px_y,
		                          u_dx * tile.y_px_x + u_dy * tile.y_px_y, v_dx * tile.y_px_x + v_dy * tile.y_px_y};
		return light * look.texture->sample(u, v, footprint);
	}

   private:
	struct Look
	{
		const Texture* texture;  // null: albedo everywhere
		float albedo;
		float emission;
	};
	Lighting lighting_;
	std::vector<std::unique_ptr<Texture>> textures_;
	std::vector<Look> looks_;
};
}  // namespace viwo::sim
