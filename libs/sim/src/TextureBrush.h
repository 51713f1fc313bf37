#pragma once

#include <random>

#include "Texture.h"

namespace viwo::sim
{
/** Draws on a canvas in metres, u to the right and v up, with area-exact rims. One brush, one generator, so that a seed fixes the picture.
 */
class TextureBrush
{
   public:
	/** A canvas of about `texel_m`; the sides become powers of two, at most `max_texels`. */
	TextureBrush(double width_m, double height_m, bool tiled, double texel_m, int max_texels, float albedo, uint64_t seed);

	double width_m() const { return canvas_.width_m; }
	double height_m() const { return canvas_.height_m; }
	const Canvas& canvas() const { return canvas_; }

	/** Uniform in [low, high). */
	double random(double low, double high);
	int randomInt(int low, int high) { return low + static_cast<int>(random(0, high - low + 1)); }

	void rectangle(double u0, double v0, double u1, double v1, double albedo, double opacity = 1);
	void frame(double u0, double v0, double u1, double v1, double thickness, double albedo);
	void disc(double u, double v, double radius, double albedo, double opacity = 1);

	/** Smooth multiplicative variation, cells of `scale_u` by `scale_v`, relative amplitude (uniform lattice values). */
	void mottle(double amplitude, double scale_u, double scale_v);
	/** Independent multiplicative variation of each texel. */
	void grain(double amplitude);
	/** Small discs, `per_m2` of them. */
	void specks(double per_m2, double min_radius, double max_radius, double albedo, double opacity);

	/** Rows of word-like groups of letter-like strokes, from the top. */
	void text(double u0, double v0, double u1, double v1, double line_m, double albedo);

   private:
	float& texel(int x, int y);
	void blend(int x, int y, double coverage, double albedo);
	void letter(double u, double v, double size_m, double albedo);

	Canvas canvas_;
	std::mt19937_64 generator_;
};
}  // namespace viwo::sim
