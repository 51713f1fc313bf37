#pragma once

#include <viwo/core/Pose3.h>
#include <viwo/sim/World.h>

#include <array>
#include <optional>

#include "LensTable.h"

namespace viwo::sim
{
/** An affine function of the normalised image plane. */
struct Affine
{
	float x, y, c;
	float at(float px, float py) const { return x * px + y * py + c; }
};

/** A surface as one camera sees it. Along the ray through (x, y, 1), q = 1 / z, u q and v q are affine in x and y: exact, and without
 *  trigonometry or division until the nearest surface is known.
 */
struct SurfaceView
{
	size_t surface;
	Affine q, uq, vq;
	float width, height;
	float max_q;  // of the part in front of the camera
	bool front;   // its front is seen
	bool thin;    // in places narrower than pixels are apart
	int corners;  // of its outline on the normalised plane, cut off at the near plane
	std::array<float, 8> outline_x, outline_y;
	float low_x, high_x, low_y, high_y;
};

/** What a camera at T_WC sees of a surface; nothing when that is its back or lies behind the near plane. */
std::optional<SurfaceView> viewSurface(const Surface& surface, size_t index, const Pose3& T_CW, double focal_px);

/** False only when no pixel of the tile can show the surface. */
bool mayCover(const SurfaceView& view, const LensTable::Tile& tile);
}  // namespace viwo::sim
