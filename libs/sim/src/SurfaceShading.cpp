#include "SurfaceShading.h"

#include <map>
#include <tuple>

#include "TexturePainter.h"

namespace viwo::sim
{
SurfaceShading::SurfaceShading(const World& world) : lighting_(world)
{
	// Surfaces that would get the same picture share it.
	std::map<std::tuple<size_t, double, double, uint32_t>, const Texture*> painted;
	for (const auto& s : world.surfaces())
	{
		const Material& m = world.materialOf(s);
		const bool fitted = isFitted(m.texture);
		const auto key = fitted ? std::make_tuple(s.material, s.width_m, s.height_m, s.variant) : std::make_tuple(s.material, 0.0, 0.0, 0u);
		const auto [found, is_new] = painted.try_emplace(key, nullptr);
		if (is_new)
		{
			textures_.push_back(std::make_unique<Texture>(paintTexture(m, s.width_m, s.height_m, fitted ? s.variant : 0)));
			found->second = textures_.back().get();
		}
		looks_.push_back({found->second->isFlat() ? nullptr : found->second, static_cast<float>(m.albedo), static_cast<float>(m.emission)});
	}
}
}  // namespace viwo::sim
