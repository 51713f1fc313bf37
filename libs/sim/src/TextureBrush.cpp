#include "TextureBrush.h"

#include <algorithm>

namespace viwo::sim
{
namespace
{
int texelsFor(double length_m, double texel_m, int max_texels)
{
	int n = 4;
	while (n < max_texels && n * texel_m < length_m) n *= 2;
	return n;
}

float smooth(float x)
{
	return x * x * (3 - 2 * x);
}
}  // namespace

TextureBrush::TextureBrush(double width_m, double height_m, bool tiled, double texel_m, int max_texels, float albedo, uint64_t seed)
    : canvas_{texelsFor(width_m, texel_m, max_texels), texelsFor(height_m, texel_m, max_texels), width_m, height_m, tiled, {}},
      generator_(seed)
{
	canvas_.albedo.assign(static_cast<size_t>(canvas_.width) * static_cast<size_t>(canvas_.height), albedo);
}

double TextureBrush::random(double low, double high)
{
	return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1.0p-53;
}

float& TextureBrush::texel(int x, int y)
{
	return canvas_.albedo[static_cast<size_t>(y) * static_cast<size_t>(canvas_.width) + static_cast<size_t>(x)];
}

void TextureBrush::blend(int x, int y, double coverage, double albedo)
{
	if (canvas_.tiled)
	{
		x &= canvas_.width - 1;
		y &= canvas_.height - 1;
	}
	else if (x < 0 || y < 0 || x >= canvas_.width || y >= canvas_.height)
		return;
	float& a = texel(x, y);
	a += static_cast<float>(coverage * (albedo - a));
}

void TextureBrush::rectangle(double u0, double v0, double u1, double v1, double albedo, double opacity)
{
	const double su = canvas_.width / canvas_.width_m, sv = canvas_.height / canvas_.height_m;
	const double x0 = u0 * su, x1 = u1 * su, y0 = v0 * sv, y1 = v1 * sv;
	for (int y = static_cast<int>(std::floor(y0)); y < y1; ++y)
		for (int x = static_cast<int>(std::floor(x0)); x < x1; ++x)
		{
			const double covered = (std::min(x1, x + 1.0) - std::max(x0, static_cast<double>(x))) *
			                       (std::min(y1, y + 1.0) - std::max(y0, static_cast<double>(y)));
			blend(x, y, opacity * covered, albedo);
		}
}

void TextureBrush::frame(double u0, double v0, double u1, double v1, double thickness, double albedo)
{
	rectangle(u0, v0, u1, v0 + thickness, albedo);
	rectangle(u0, v1 - thickness, u1, v1, albedo);
	rectangle(u0, v0 + thickness, u0 + thickness, v1 - thickness, albedo);
	rectangle(u1 - thickness, v0 + thickness, u1, v1 - thickness, albedo);
}

void TextureBrush::disc(double u, double v, double radius, double albedo, double opacity)
{
	const double mu = canvas_.width_m / canvas_.width, mv = canvas_.height_m / canvas_.height;
	const double soft = 0.5 * std::max(mu, mv);
	for (int y = static_cast<int>(std::floor((v - radius - soft) / mv)); y <= (v + radius + soft) / mv; ++y)
		for (int x = static_cast<int>(std::floor((u - radius - soft) / mu)); x <= (u + radius + soft) / mu; ++x)
		{
			const double distance = std::hypot((x + 0.5) * mu - u, (y + 0.5) * mv - v);
			blend(x, y, opacity * std::clamp((radius + soft - distance) / (2 * soft), 0.0, 1.0), albedo);
		}
}

void TextureBrush::mottle(double amplitude, double scale_u, double scale_v)
{
	// The lattice divides the canvas, so that a tiled one has no seam.
	const int cells_x = std::max(1, static_cast<int>(std::lround(canvas_.width_m / scale_u)));
	const int cells_y = std::max(1, static_cast<int>(std::lround(canvas_.height_m / scale_v)));
	std::vector<float> lattice(static_cast<size_t>(cells_x) * static_cast<size_t>(cells_y));
	for (auto& value : lattice) value = static_cast<float>(random(-amplitude, amplitude));
	const auto at = [&](int x, int y)
	{ return lattice[static_cast<size_t>(y % cells_y) * static_cast<size_t>(cells_x) + static_cast<size_t>(x % cells_x)]; };
	for (int y = 0; y < canvas_.height; ++y)
	{
		const float v = (static_cast<float>(y) + 0.5f) * static_cast<float>(cells_y) / static_cast<float>(canvas_.height);
		const int y0 = static_cast<int>(v);
		const float fy = smooth(v - static_cast<float>(y0));
		for (int x = 0; x < canvas_.width; ++x)
		{
			const float u = (static_cast<float>(x) + 0.5f) * static_cast<float>(cells_x) / static_cast<float>(canvas_.width);
			const int x0 = static_cast<int>(u);
			const float fx = smooth(u - static_cast<float>(x0));
			const float low = at(x0, y0) + fx * (at(x0 + 1, y0) - at(x0, y0)),
			            high = at(x0, y0 + 1) + fx * (at(x0 + 1, y0 + 1) - at(x0, y0 + 1));
			texel(x, y) *= 1 + low + fy * (high - low);
		}
	}
}

void TextureBrush::grain(double amplitude)
{
	for (auto& a : canvas_.albedo) a *= static_cast<float>(1 + random(-amplitude, amplitude));
}

void TextureBrush::specks(double per_m2, double min_radius, double max_radius, double albedo, double opacity)
{
	const int count = static_cast<int>(per_m2 * canvas_.width_m * canvas_.height_m);
	for (int i = 0; i < count; ++i)
	{
		const double u = random(0, canvas_.width_m), v = random(0, canvas_.height_m);
		disc(u, v, random(min_radius, max_radius), albedo, opacity * random(0.3, 1));
	}
}

void TextureBrush::letter(double u, double v, double size_m, double albedo)
{
	const double stroke = 0.16 * size_m, width = 0.55 * size_m;
	const int strokes = randomInt(2, 4);
	for (int i = 0; i < strokes; ++i)
	{
		if (random(0, 1) < 0.5)
		{
			const double at = u + random(0, 1) * (width - stroke);
			rectangle(at, v, at + stroke, v + size_m * random(0.6, 1), albedo);
		}
		else
		{
			const double at = v + random(0, 1) * (size_m - stroke);
			rectangle(u, at, u + width, at + stroke, albedo);
		}
	}
}

void TextureBrush::text(double u0, double v0, double u1, double v1, double line_m, double albedo)
{
	const double size = 0.6 * line_m, advance = 0.72 * size;
	for (double v = v1 - line_m; v >= v0; v -= line_m)
	{
		const double end = u0 + (u1 - u0) * random(0.6, 1);
		double u = u0;
		while (u + advance < end)
		{
			for (int letters = randomInt(2, 8); letters > 0 && u + advance < end; --letters, u += advance) letter(u, v, size, albedo);
			u += advance;
		}
	}
}
}  // namespace viwo::sim
