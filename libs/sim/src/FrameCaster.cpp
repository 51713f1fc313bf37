#include "FrameCaster.h"

#include <algorithm>
#include <cmath>

namespace viwo::sim
{
namespace
{
// Neighbouring surfaces share their edges: this much (m) covers the rounding of single precision.
constexpr float kSeam_m = 2e-5f;
constexpr int32_t kNothing = -1;

/** Keeps in best_q and best_view what is nearest; a loop without branches, for the compiler to vectorise. */
template <size_t n>
void castRays(const SurfaceView& view, int32_t index, const float* __restrict x, const float* __restrict y, float* __restrict best_q,
              int32_t* __restrict best_view)
{
	const Affine q_of = view.q, uq_of = view.uq, vq_of = view.vq;
	const float width = view.width + kSeam_m, height = view.height + kSeam_m;
	for (size_t i = 0; i < n; ++i)
	{
		const float q = q_of.at(x[i], y[i]), uq = uq_of.at(x[i], y[i]), vq = vq_of.at(x[i], y[i]);
		const bool nearer = (q > best_q[i]) & (uq >= -kSeam_m * q) & (uq <= width * q) & (vq >= -kSeam_m * q) & (vq <= height * q);
		best_q[i] = nearer ? q : best_q[i];
		best_view[i] = nearer ? index : best_view[i];
	}
}

struct SamplePattern
{
	static constexpr size_t kCount = 16;
	std::array<float, kCount> x, y;

	/** Hammersley points: each of the 16 columns and rows of a pixel has one, so that upright and level edges are weighed finely too. */
	SamplePattern()
	{
		for (unsigned i = 0; i < kCount; ++i)
		{
			const unsigned reversed = (i & 1) << 3 | (i & 2) << 1 | (i & 4) >> 1 | (i & 8) >> 3;
			x[i] = (static_cast<float>(i) + 0.5f) / kCount - 0.5f;
			y[i] = (static_cast<float>(reversed) + 0.5f) / kCount - 0.5f;
		}
	}
};
}  // namespace

FrameCaster::FrameCaster(const World& world, const CameraModel& camera)
    : width_px_(camera.width_px()),
      height_px_(camera.height_px()),
      focal_px_(camera.meanFocal_px()),
      surfaces_(world.surfaces()),
      lens_(std::make_shared<const LensTable>(camera)),
      shading_(std::make_shared<const SurfaceShading>(world)),
      view_of_pixel_(static_cast<size_t>(width_px_) * static_cast<size_t>(height_px_)),
      is_outline_(view_of_pixel_.size())
{
}

void FrameCaster::add(const Pose3& T_WC, float weight, RadianceImage& image)
{
	const Pose3 T_CW = T_WC.inverse();
	views_.clear();
	for (size_t i = 0; i < surfaces_.size(); ++i)
		if (const auto view = viewSurface(surfaces_[i], i, T_CW, focal_px_)) views_.push_back(*view);

	std::fill(is_outline_.begin(), is_outline_.end(), uint8_t{0});
	kept_views_.clear();
	kept_until_.clear();
	for (const auto& tile : lens_->tiles()) castTile(tile);
	markOutlines();
	for (size_t i = 0; i < lens_->tiles().size(); ++i) shadeTile(lens_->tiles()[i], i, weight, image);
}

void FrameCaster::chooseCandidates(const LensTable::Tile& tile)
{
	candidates_.clear();
	float behind = 0;  // inverse depth of the nearest surface that fills the tile
	for (size_t i = 0; i < views_.size(); ++i)
	{
		const SurfaceView& view = views_[i];
		if (view.max_q < behind || !mayCover(view, tile)) continue;
		float min_q = INFINITY, max_q = -INFINITY;
		bool inside = true;
		for (float x : {tile.low_x, tile.high_x})
			for (float y : {tile.low_y, tile.high_y})
			{
				const float q = view.q.at(x, y), uq = view.uq.at(x, y), vq = view.vq.at(x, y);
				min_q = std::min(min_q, q);
				max_q = std::max(max_q, q);
				inside = inside && q > 0 && uq >= 0 && vq >= 0 && uq <= view.width * q && vq <= view.height * q;
			}
		max_q = std::min(max_q, view.max_q);
		if (max_q < behind) continue;
		if (inside) behind = std::max(behind, min_q);
		candidates_.push_back({static_cast<uint32_t>(i), min_q, max_q, inside});
	}
	candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(), [&](const Candidate& c) { return c.max_q < behind; }),
	                  candidates_.end());
}

void FrameCaster::castTile(const LensTable::Tile& tile)
{
	chooseCandidates(tile);
	castPixels(tile, candidates_);
	for (const auto& c : candidates_)
	{
		kept_views_.push_back(c.view);
		if (views_[c.view].thin) markThin(tile, views_[c.view]);
	}
	kept_until_.push_back(kept_views_.size());
	for (int y = 0; y < tile.rows; ++y)
		std::copy_n(best_view_.begin() + y * LensTable::kTile_px, tile.columns,
		            view_of_pixel_.begin() + static_cast<std::ptrdiff_t>(pixelIndex(tile.x_px, tile.y_px + y)));
}

void FrameCaster::castPixels(const LensTable::Tile& tile, const std::vector<Candidate>& candidates)
{
	const float *x = lens_->x() + tile.first, *y = lens_->y() + tile.first;
	best_q_.fill(0);
	best_view_.fill(kNothing);
	if (candidates.size() == 1 && candidates[0].covers_all)
	{
		best_view_.fill(static_cast<int32_t>(candidates[0].view));
		return;
	}
	for (const auto& c : candidates)
		castRays<LensTable::kTilePixels>(views_[c.view], static_cast<int32_t>(c.view), x, y, best_q_.data(), best_view_.data());
}

void FrameCaster::markThin(const LensTable::Tile& tile, const SurfaceView& view)
{
	// A strip may pass between the pixels' centres: mark every pixel that it comes near.
	for (int row = 0; row < tile.rows; ++row)
		for (int column = 0; column < tile.columns; ++column)
		{
			const size_t i = static_cast<size_t>(row * LensTable::kTile_px + column);
			const float x = lens_->x()[tile.first + i], y = lens_->y()[tile.first + i];
			const float q = view.q.at(x, y), uq = view.uq.at(x, y), vq = view.vq.at(x, y);
			const auto reach = [&](const Affine& f)
			{ return std::abs(f.x * tile.x_px_x + f.y * tile.x_px_y) + std::abs(f.x * tile.y_px_x + f.y * tile.y_px_y); };
			const float reach_q = reach(view.q), reach_u = reach(view.uq) + view.width * reach_q,
			            reach_v = reach(view.vq) + view.height * reach_q;
			const bool near_it = uq >= -reach_u && uq <= view.width * q + reach_u && vq >= -reach_v && vq <= view.height * q + reach_v;
			if (near_it && q + reach_q >= best_q_[i]) is_outline_[pixelIndex(tile.x_px + column, tile.y_px + row)] = 1;
		}
}

void FrameCaster::markOutlines()
{
	for (int y = 0; y < height_px_; ++y)
		for (int x = 0; x < width_px_; ++x)
		{
			const size_t i = pixelIndex(x, y);
			if (x + 1 < width_px_ && view_of_pixel_[i] != view_of_pixel_[i + 1]) is_outline_[i] = is_outline_[i + 1] = 1;
			if (y + 1 < height_px_ && view_of_pixel_[i] != view_of_pixel_[i + static_cast<size_t>(width_px_)])
				is_outline_[i] = is_outline_[i + static_cast<size_t>(width_px_)] = 1;
		}
}

void FrameCaster::shadeTile(const LensTable::Tile& tile, size_t index, float weight, RadianceImage& image) const
{
	for (int row = 0; row < tile.rows; ++row)
	{
		const size_t first_pixel = pixelIndex(tile.x_px, tile.y_px + row),
		             first_ray = tile.first + static_cast<size_t>(row) * LensTable::kTile_px;
		for (size_t column = 0; column < static_cast<size_t>(tile.columns); ++column)
		{
			const float x = lens_->x()[first_ray + column], y = lens_->y()[first_ray + column];
			const size_t pixel = first_pixel + column;
			const int32_t view = view_of_pixel_[pixel];
			if (is_outline_[pixel])
				image.pixels[pixel] += weight * outlineRadiance(tile, index, x, y);
			else if (view != kNothing)
				image.pixels[pixel] += weight * shading_->radiance(views_[static_cast<size_t>(view)], x, y, tile);
		}
	}
}

float FrameCaster::outlineRadiance(const LensTable::Tile& tile, size_t index, float x, float y) const
{
	static const SamplePattern pattern;
	constexpr size_t n = SamplePattern::kCount;
	std::array<float, n> xs, ys, best_q{};
	std::array<int32_t, n> best_view;
	best_view.fill(kNothing);
	for (size_t i = 0; i < n; ++i)
	{
		xs[i] = x + pattern.x[i] * tile.x_px_x + pattern.y[i] * tile.y_px_x;
		ys[i] = y + pattern.x[i] * tile.x_px_y + pattern.y[i] * tile.y_px_y;
	}
	for (size_t k = index == 0 ? 0 : kept_until_[index - 1]; k < kept_until_[index]; ++k)
		castRays<n>(views_[kept_views_[k]], static_cast<int32_t>(kept_views_[k]), xs.data(), ys.data(), best_q.data(), best_view.data());

	// Each surface is shaded once, at the middle of its samples, so that it does not reach beyond its rim.
	float sum = 0;
	for (size_t i = 0; i < n; ++i)
	{
		const int32_t view = best_view[i];
		if (view == kNothing) continue;
		float count = 0, x_sum = 0, y_sum = 0;
		for (size_t j = i; j < n; ++j)
			if (best_view[j] == view)
			{
				count += 1;
				x_sum += xs[j];
				y_sum += ys[j];
				if (j > i) best_view[j] = kNothing;
			}
		sum += count / n * shading_->radiance(views_[static_cast<size_t>(view)], x_sum / count, y_sum / count, tile);
	}
	return sum;
}
}  // namespace viwo::sim
