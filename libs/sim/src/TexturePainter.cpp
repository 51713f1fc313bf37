#include "TexturePainter.h"

#include <algorithm>
#include <cmath>

#include "TextureBrush.h"

namespace viwo::sim
{
namespace
{
constexpr double kWallPeriod_m = 4.096;

struct Subject
{
	const Material& material;
	double width_m, height_m;
	uint64_t seed;

	double albedo() const { return material.albedo; }
	double contrast() const { return material.contrast; }
	TextureBrush tiled(double period_m, int texels) const
	{
		return {period_m, period_m, true, period_m / texels, texels, static_cast<float>(material.albedo), seed};
	}
	TextureBrush fitted(double texel_m) const
	{
		return {width_m, height_m, false, texel_m, 1024, static_cast<float>(material.albedo), seed};
	}
};

Canvas checker(const Subject& s)
{
	TextureBrush brush = s.tiled(2 * s.material.cell_m, 256);
	const double cell = s.material.cell_m, bright = s.albedo() * (1 + s.contrast()), dark = s.albedo() * (1 - s.contrast());
	brush.rectangle(0, 0, 2 * cell, 2 * cell, dark);
	brush.rectangle(0, 0, cell, cell, bright);
	brush.rectangle(cell, cell, 2 * cell, 2 * cell, bright);
	return brush.canvas();
}

/** Rolled-on paint: what a camera sees of it is mostly unevenness at the scale of decimetres. */
TextureBrush paintBrush(const Subject& s)
{
	TextureBrush brush = s.tiled(kWallPeriod_m, 1024);
	brush.mottle(0.020 * s.contrast(), 0.9, 0.9);
	brush.mottle(0.016 * s.contrast(), 0.24, 0.24);
	brush.mottle(0.016 * s.contrast(), 0.06, 0.06);
	brush.mottle(0.020 * s.contrast(), 0.016, 0.016);
	return brush;
}

Canvas scuffs(const Subject& s)
{
	TextureBrush brush = paintBrush(s);
	const double dark = s.albedo() * (1 - s.contrast());
	for (int i = 0; i < 26; ++i)
	{
		const double u = brush.random(0, kWallPeriod_m), v = 0.12 + brush.random(0, 0.5) * brush.random(0.2, 1.6);
		const double length = brush.random(0.02, 0.2), thickness = brush.random(0.003, 0.010);
		brush.rectangle(u, v, u + length, v + thickness, dark, brush.random(0.15, 0.6));
	}
	for (int i = 0; i < 12; ++i)
		brush.disc(brush.random(0, kWallPeriod_m), brush.random(0.15, 1.9), brush.random(0.004, 0.012), dark, brush.random(0.2, 0.7));
	return brush.canvas();
}

Canvas tiles(const Subject& s)
{
	const double cell = s.material.cell_m;
	const int count = std::max(1, static_cast<int>(std::lround(kWallPeriod_m / cell)));
	TextureBrush brush = s.tiled(count * cell, 2048);
	for (int y = 0; y < count; ++y)
		for (int x = 0; x < count; ++x)
			brush.rectangle(x * cell, y * cell, (x + 1) * cell, (y + 1) * cell,
			                s.albedo() * (1 + 0.05 * s.contrast() * brush.random(-1, 1)));
	brush.mottle(0.03 * s.contrast(), 0.35, 0.35);
	brush.mottle(0.05 * s.contrast(), 0.03, 0.03);
	brush.specks(160, 0.0015, 0.005, s.albedo() * 0.55, 0.7 * s.contrast());
	brush.specks(5, 0.004, 0.013, s.albedo() * 0.5, s.contrast());
	constexpr double kJoint_m = 0.005;
	for (int i = 0; i < count; ++i)
	{
		const double at = i * cell - 0.5 * kJoint_m;
		brush.rectangle(at, 0, at + kJoint_m, brush.height_m(), s.albedo() * (1 - 0.6 * s.contrast()));
		brush.rectangle(0, at, brush.width_m(), at + kJoint_m, s.albedo() * (1 - 0.6 * s.contrast()));
	}
	return brush.canvas();
}

Canvas carpet(const Subject& s)
{
	TextureBrush brush = s.tiled(kWallPeriod_m, 2048);
	brush.mottle(0.06 * s.contrast(), 0.7, 0.7);
	brush.mottle(0.10 * s.contrast(), 0.05, 0.05);
	brush.mottle(0.30 * s.contrast(), 0.010, 0.010);
	brush.specks(9, 0.004, 0.016, s.albedo() * 0.5, s.contrast());
	brush.specks(5, 0.003, 0.010, std::min(0.9, s.albedo() * 1.9), s.contrast());
	return brush.canvas();
}

Canvas wood(const Subject& s)
{
	TextureBrush brush = s.tiled(2.048, 1024);
	brush.mottle(0.10 * s.contrast(), 0.05, 1.0);
	brush.mottle(0.12 * s.contrast(), 0.012, 0.5);
	return brush.canvas();
}

Canvas fabric(const Subject& s)
{
	TextureBrush brush = s.tiled(1.024, 512);
	brush.mottle(0.15 * s.contrast(), 0.2, 0.2);
	brush.mottle(0.25 * s.contrast(), 0.008, 0.008);
	return brush.canvas();
}

Canvas leaves(const Subject& s)
{
	TextureBrush brush = s.tiled(1.024, 512);
	for (int i = 0; i < 420; ++i)
		brush.disc(brush.random(0, 1.024), brush.random(0, 1.024), brush.random(0.015, 0.05),
		           s.albedo() * (1 + s.contrast() * brush.random(-1, 1)), 0.85);
	return brush.canvas();
}

Canvas metal(const Subject& s)
{
	TextureBrush brush = s.tiled(1.024, 512);
	brush.mottle(0.12 * s.contrast(), 0.5, 0.006);
	brush.mottle(0.10 * s.contrast(), 0.3, 0.3);
	return brush.canvas();
}

void posterPicture(TextureBrush& brush, double u0, double v0, double u1, double v1)
{
	brush.rectangle(u0, v0, u1, v1, brush.random(0.15, 0.6));
	const double size = std::min(u1 - u0, v1 - v0);
	for (int i = 0; i < 9; ++i)
	{
		const double u = brush.random(u0, u1), v = brush.random(v0, v1), w = size * brush.random(0.08, 0.35),
		             h = size * brush.random(0.08, 0.35);
		const double albedo = brush.random(0.08, 0.85);
		if (i % 3 == 0)
			brush.disc(std::clamp(u, u0 + w / 2, u1 - w / 2), std::clamp(v, v0 + w / 2, v1 - w / 2), w / 2, albedo);
		else
			brush.rectangle(u, v, std::min(u1, u + w), std::min(v1, v + h), albedo);
	}
}

Canvas poster(const Subject& s)
{
	TextureBrush brush = s.fitted(0.0012);
	const double w = s.width_m, h = s.height_m, margin = 0.06 * std::min(w, h);
	const double ink = s.albedo() * (1 - s.contrast()), split = h * brush.random(0.35, 0.5);
	brush.rectangle(0, h - 0.17 * h, w, h, brush.random(0, 1) < 0.5 ? 0.25 : 0.6);
	brush.text(margin, h - 0.15 * h, w - margin, h - 0.03 * h, 0.11 * h, brush.random(0, 1) < 0.5 ? 0.9 : 0.06);
	posterPicture(brush, margin, split, w - margin, h - 0.2 * h);
	brush.text(margin, margin, 0.48 * w, split - margin, 0.028 * h, ink);
	brush.text(0.54 * w, margin, w - margin, split - margin, 0.028 * h, ink);
	brush.frame(0, 0, w, h, 0.012, 0.2);
	return brush.canvas();
}

Canvas notices(const Subject& s)
{
	TextureBrush brush = s.fitted(0.0015);
	const double w = s.width_m, h = s.height_m;
	brush.mottle(0.15 * s.contrast(), 0.02, 0.02);
	const int columns = std::max(1, static_cast<int>(w / 0.27)), rows = std::max(1, static_cast<int>(h / 0.36));
	for (int i = 0; i < columns * rows; ++i)
	{
		if (brush.random(0, 1) < 0.2) continue;
		const int column = i % columns, row = i / columns;
		const double u = (column + 0.5) * w / columns + brush.random(-0.02, 0.02), v = (row + 0.5) * h / rows + brush.random(-0.02, 0.02);
		const bool portrait = brush.random(0, 1) < 0.8;
		const double half_w = portrait ? 0.105 : 0.12, half_h = portrait ? 0.1485 : 0.09;
		brush.rectangle(u - half_w, v - half_h, u + half_w, v + half_h, brush.random(0.7, 0.92));
		brush.text(u - 0.85 * half_w, v + 0.55 * half_h, u + 0.85 * half_w, v + 0.9 * half_h, 0.035, 0.1);
		if (brush.random(0, 1) < 0.4) posterPicture(brush, u - 0.8 * half_w, v - 0.3 * half_h, u + 0.8 * half_w, v + 0.45 * half_h);
		brush.text(u - 0.85 * half_w, v - 0.9 * half_h, u + 0.85 * half_w, v + 0.45 * half_h, 0.016, 0.2);
		brush.disc(u, v + 0.93 * half_h, 0.006, 0.1);
	}
	brush.frame(0, 0, w, h, 0.025, 0.35);
	return brush.canvas();
}

Canvas sign(const Subject& s)
{
	TextureBrush brush = s.fitted(0.0008);
	const double w = s.width_m, h = s.height_m, ink = s.albedo() * (1 - s.contrast());
	brush.frame(0, 0, w, h, 0.04 * std::min(w, h), ink);
	brush.text(0.1 * w, 0.45 * h, 0.9 * w, 0.95 * h, 0.45 * h, ink);
	brush.text(0.1 * w, 0.08 * h, 0.9 * w, 0.42 * h, 0.16 * h, ink);
	return brush.canvas();
}

Canvas door(const Subject& s)
{
	TextureBrush brush = s.fitted(0.002);
	const double w = s.width_m, h = s.height_m;
	brush.mottle(0.05 * s.contrast(), 0.04, 1.2);
	brush.mottle(0.05 * s.contrast(), 0.01, 0.6);
	brush.rectangle(0.02, 0.03, w - 0.02, 0.23, 0.5);  // kick plate
	brush.frame(0.02, 0.03, w - 0.02, 0.23, 0.004, 0.2);
	brush.disc(w - 0.07, 0.93 * 1.05, 0.022, 0.3);  // lock below the handle
	brush.disc(w - 0.07, 0.93 * 1.05, 0.008, 0.05);
	for (double v : {0.25, 1.02, 1.8})
		if (v < h - 0.1) brush.rectangle(0, v, 0.012, v + 0.1, 0.35);  // hinges
	brush.frame(0, 0, w, h, 0.006, 0.12);
	return brush.canvas();
}

Canvas light(const Subject& s)
{
	TextureBrush brush = s.fitted(0.005);
	const double w = s.width_m, h = s.height_m;
	const int bars = std::max(1, static_cast<int>(std::max(w, h) / 0.3));
	for (int i = 1; i < bars; ++i)
	{
		if (w > h)
			brush.rectangle(w * i / bars - 0.01, 0, w * i / bars + 0.01, h, 0.35 * s.albedo());
		else
			brush.rectangle(0, h * i / bars - 0.01, w, h * i / bars + 0.01, 0.35 * s.albedo());
	}
	brush.frame(0, 0, w, h, 0.03, 0.15 * s.albedo());
	return brush.canvas();
}

Canvas window(const Subject& s)
{
	TextureBrush brush = s.fitted(0.005);
	const double w = s.width_m, h = s.height_m;
	const double skyline = h * brush.random(0.25, 0.4);
	brush.rectangle(0, 0, w, skyline, 0.45 * s.albedo());
	for (double u = 0; u < w;)
	{
		const double width = brush.random(0.2, 0.7);
		brush.rectangle(u, 0, u + width, skyline + brush.random(-0.1, 0.35) * h, s.albedo() * brush.random(0.35, 0.7));
		u += width * brush.random(0.7, 1.4);
	}
	brush.mottle(0.06 * s.contrast(), 0.5, 0.5);
	const int panes = std::max(1, static_cast<int>(w / 0.9));
	for (int i = 1; i < panes; ++i) brush.rectangle(w * i / panes - 0.025, 0, w * i / panes + 0.025, h, 0.3 * s.albedo());
	if (h > 1.5) brush.rectangle(0, 0.42 * h - 0.02, w, 0.42 * h + 0.02, 0.3 * s.albedo());
	brush.frame(0, 0, w, h, 0.05, 0.3 * s.albedo());
	return brush.canvas();
}
}  // namespace

bool isFitted(TextureKind kind)
{
	switch (kind)
	{
		case TextureKind::poster:
		case TextureKind::notices:
		case TextureKind::sign:
		case TextureKind::door:
		case TextureKind::light:
		case TextureKind::window:
			return true;
		default:
			return false;
	}
}

Canvas paintTexture(const Material& material, double width_m, double height_m, uint32_t variant)
{
	const Subject s{material, width_m, height_m, static_cast<uint64_t>(material.seed) * 7919 + variant};
	switch (material.texture)
	{
		case TextureKind::plain:
			return s.tiled(1, 4).canvas();
		case TextureKind::checker:
			return checker(s);
		case TextureKind::paint:
			return paintBrush(s).canvas();
		case TextureKind::tiles:
			return tiles(s);
		case TextureKind::carpet:
			return carpet(s);
		case TextureKind::wood:
			return wood(s);
		case TextureKind::fabric:
			return fabric(s);
		case TextureKind::leaves:
			return leaves(s);
		case TextureKind::metal:
			return metal(s);
		case TextureKind::poster:
			return poster(s);
		case TextureKind::notices:
			return notices(s);
		case TextureKind::sign:
			return sign(s);
		case TextureKind::door:
			return door(s);
		case TextureKind::light:
			return light(s);
		case TextureKind::window:
			return window(s);
		case TextureKind::scuffs:
			return scuffs(s);
	}
	return s.tiled(1, 4).canvas();
}
}  // namespace viwo::sim
