#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace viwo::sim
{
/** Reflectance over a rectangle, row 0 at v = 0; the sides are powers of two. */
struct Canvas
{
	int width, height;
	double width_m, height_m;
	bool tiled;  // repeats in both directions; otherwise its rim continues
	std::vector<float> albedo;
};

/** How far u and v (m) move on the surface for one pixel to the right (x) and down (y). */
struct Footprint
{
	float u_x, v_x, u_y, v_y;
};

/** A canvas with its mip-maps, sampled over the area that a pixel sees. */
class Texture
{
   public:
	explicit Texture(const Canvas& canvas);

	/** Mean albedo around (u, v): trilinear, with up to kMaxTaps probes along the longer axis of the footprint. */
	float sample(float u_m, float v_m, const Footprint& footprint) const;

	/** All texels alike: no sampling needed. */
	bool isFlat() const { return flat_; }

   private:
	static constexpr int kMaxTaps = 8;
	/** Four texels or weights: one SIMD register where there are such. */
	using Four = float __attribute__((vector_size(16)));

	/** Every row ends with one texel more and the level with one row more, so that a 2 x 2 neighbourhood is two plain loads. */
	struct Level
	{
		float scale_s, scale_t;  // texels of this level per texel of level 0
		float max_s, max_t;      // texel coordinates end here, where the texture is not tiled
		int mask_s, mask_t;      // and wrap with these where it is
		int stride;
		size_t offset;
	};
	void appendLevel(const std::vector<float>& albedo, int width, int height, const Canvas& canvas);
	void probe(const Level& level, float s, float t, float weight, Four& sum) const;
	void probeLine(const Level& level, int taps, float s, float t, float step_s, float step_t, float weight, Four& sum) const;

	bool tiled_, flat_;
	float texels_per_u_, texels_per_v_;
	std::vector<Level> levels_;
	std::vector<uint16_t> texels_;
};

/** log2, linear between powers of two: continuous, off by 0.09 at most, which moves the blend between two mip-maps and nothing else. */
inline float coarseLog2(float x)
{
	int32_t bits;
	std::memcpy(&bits, &x, sizeof bits);
	return static_cast<float>(bits) * (1.0f / (1 << 23)) - 127.0f;
}

inline int floorToInt(float x)
{
	const int truncated = static_cast<int>(x);
	return truncated - (static_cast<float>(truncated) > x ? 1 : 0);
}
}  // namespace viwo::sim
