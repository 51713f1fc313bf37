#include "Texture.h"

#include <algorithm>
#include <cstring>

namespace viwo::sim
{
namespace
{
constexpr float kFullScale = 65535;

std::vector<float> halved(const std::vector<float>& fine, int width, int height)
{
	const int step_x = width > 1 ? 2 : 1, step_y = height > 1 ? 2 : 1;
	std::vector<float> coarse;
	coarse.reserve(fine.size() / static_cast<size_t>(step_x * step_y));
	for (int y = 0; y < height; y += step_y)
		for (int x = 0; x < width; x += step_x)
		{
			const auto at = [&](int dx, int dy)
			{ return fine[static_cast<size_t>(y + dy) * static_cast<size_t>(width) + static_cast<size_t>(x + dx)]; };
			coarse.push_back(0.25f * (at(0, 0) + at(step_x - 1, 0) + at(0, step_y - 1) + at(step_x - 1, step_y - 1)));
		}
	return coarse;
}
}  // namespace

Texture::Texture(const Canvas& canvas)
    : tiled_(canvas.tiled),
      flat_(std::all_of(canvas.albedo.begin(), canvas.albedo.end(), [&](float a) { return a == canvas.albedo[0]; })),
      texels_per_u_(static_cast<float>(canvas.width / canvas.width_m)),
      texels_per_v_(static_cast<float>(canvas.height / canvas.height_m))
{
	std::vector<float> albedo = canvas.albedo;
	for (int width = canvas.width, height = canvas.height;;)
	{
		appendLevel(albedo, width, height, canvas);
		if (width == 1 && height == 1) break;
		albedo = halved(albedo, width, height);
		width = std::max(1, width / 2);
		height = std::max(1, height / 2);
	}
}

void Texture::appendLevel(const std::vector<float>& albedo, int width, int height, const Canvas& canvas)
{
	constexpr int kAllBits = -1;
	Level level{};
	level.scale_s = static_cast<float>(width) / static_cast<float>(canvas.width);
	level.scale_t = static_cast<float>(height) / static_cast<float>(canvas.height);
	level.max_s = static_cast<float>(width - 1);
	level.max_t = static_cast<float>(height - 1);
	level.mask_s = tiled_ ? width - 1 : kAllBits;
	level.mask_t = tiled_ ? height - 1 : kAllBits;
	level.stride = width + 1;
	level.offset = texels_.size();
	levels_.push_back(level);
	for (int y = 0; y <= height; ++y)
		for (int x = 0; x <= width; ++x)
		{
			const int from_x = x < width ? x : (tiled_ ? 0 : width - 1), from_y = y < height ? y : (tiled_ ? 0 : height - 1);
			const float a = albedo[static_cast<size_t>(from_y) * static_cast<size_t>(width) + static_cast<size_t>(from_x)];
			texels_.push_back(static_cast<uint16_t>(std::clamp(a, 0.0f, 1.0f) * kFullScale + 0.5f));
		}
}

inline void Texture::probe(const Level& level, float s, float t, float weight, Four& sum) const
{
	s = s * level.scale_s - 0.5f;
	t = t * level.scale_t - 0.5f;
	if (!tiled_)
	{
		s = std::min(std::max(s, 0.0f), level.max_s);
		t = std::min(std::max(t, 0.0f), level.max_t);
	}
	const int x = floorToInt(s), y = floorToInt(t);
	const float fx = s - static_cast<float>(x), fy = t - static_cast<float>(y);
	const uint16_t* low = texels_.data() + level.offset + static_cast<size_t>((y & level.mask_t) * level.stride + (x & level.mask_s));
	const uint16_t* high = low + level.stride;

	using FourTexels = uint16_t __attribute__((vector_size(8)));
	FourTexels texels;
	std::memcpy(&texels, low, 4);
	std::memcpy(reinterpret_cast<char*>(&texels) + 4, high, 4);
	const float top = weight * fy, bottom = weight - top;
	const Four across = {1 - fx, fx, 1 - fx, fx}, along = {bottom, bottom, top, top};
	sum += __builtin_convertvector(texels, Four) * across * along;
}

inline void Texture::probeLine(const Level& level, int taps, float s, float t, float span_s, float span_t, float weight, Four& sum) const
{
	const float step = 1.0f / static_cast<float>(taps), first = 0.5f * step - 0.5f;
	for (int i = 0; i < taps; ++i)
	{
		const float along = first + step * static_cast<float>(i);
		probe(level, s + along * span_s, t + along * span_t, weight * step, sum);
	}
}

float Texture::sample(float u_m, float v_m, const Footprint& f) const
{
	const float s = u_m * texels_per_u_, t = v_m * texels_per_v_;
	float s_a = f.u_x * texels_per_u_, t_a = f.v_x * texels_per_v_, s_b = f.u_y * texels_per_u_, t_b = f.v_y * texels_per_v_;
	float a2 = s_a * s_a + t_a * t_a, b2 = s_b * s_b + t_b * t_b;
	const float area = std::abs(s_a * t_b - s_b * t_a);
	if (a2 < b2)
	{
		std::swap(a2, b2);
		std::swap(s_a, s_b);
		std::swap(t_a, t_b);
	}
	Four sum{};
	if (a2 <= 1)
		probe(levels_[0], s, t, 1, sum);
	else
	{
		// The parallelogram's longer side a is probed step by step; its height area / |a| sets the mip-map, squared here to save the root.
		const float width2 = std::max(area * area / a2, a2 / (kMaxTaps * kMaxTaps));
		const float lod = std::max(0.0f, 0.5f * coarseLog2(width2));
		const float ratio = std::sqrt(a2 / std::max(width2, 1.0f));
		// A probe reaches one texel to either side: neighbours may be 1.5 apart. The coarser map needs half as many.
		const int taps = std::clamp(static_cast<int>(ratio * 0.667f + 0.75f), 1, kMaxTaps);
		const auto below = static_cast<size_t>(lod);
		if (below + 1 >= levels_.size())
			probe(levels_.back(), s, t, 1, sum);
		else
		{
			const float upper = lod - static_cast<float>(below);
			probeLine(levels_[below], taps, s, t, s_a, t_a, 1 - upper, sum);
			if (upper > 0) probeLine(levels_[below + 1], (taps + 1) / 2, s, t, s_a, t_a, upper, sum);
		}
	}
	return (sum[0] + sum[1] + sum[2] + sum[3]) * (1 / kFullScale);
}
}  // namespace viwo::sim
