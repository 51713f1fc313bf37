#include "SurfaceView.h"

#include <algorithm>
#include <cmath>

namespace viwo::sim
{
namespace
{
using Eigen::Vector3d;

constexpr double kNear_m = 0.02;

/** The rectangle's corners in front of the near plane (Sutherland and Hodgman, one plane): up to five. */
std::array<Vector3d, 5> cutAtNearPlane(const std::array<Vector3d, 4>& corners, int& count)
{
	std::array<Vector3d, 5> kept;
	count = 0;
	for (size_t i = 0; i < 4; ++i)
	{
		const Vector3d &a = corners[i], &b = corners[(i + 1) % 4];
		const double da = a.z() - kNear_m, db = b.z() - kNear_m;
		if (da >= 0) kept[static_cast<size_t>(count++)] = a;
		if ((da >= 0) != (db >= 0) && count < 5) kept[static_cast<size_t>(count++)] = a + da / (da - db) * (b - a);
	}
	return kept;
}

Affine affine(const Vector3d& row)
{
	return {static_cast<float>(row.x()), static_cast<float>(row.y()), static_cast<float>(row.z())};
}

/** Area over longest extent: the width of a band however it lies. */
double narrowness_px(const SurfaceView& view, double focal_px)
{
	double area2 = 0, extent = 0;
	for (int i = 0; i < view.corners; ++i)
	{
		const auto a = static_cast<size_t>(i), b = static_cast<size_t>((i + 1) % view.corners);
		area2 += static_cast<double>(view.outline_x[a] * view.outline_y[b] - view.outline_x[b] * view.outline_y[a]);
		for (int j = 0; j < i; ++j)
		{
			const auto c = static_cast<size_t>(j);
			extent = std::max(
			    extent, static_cast<double>(std::hypot(view.outline_x[a] - view.outline_x[c], view.outline_y[a] - view.outline_y[c])));
		}
	}
	return extent > 0 ? focal_px * 0.5 * std::abs(area2) / extent : 0;
}
}  // namespace

std::optional<SurfaceView> viewSurface(const Surface& s, size_t index, const Pose3& T_CW, double focal_px)
{
	const Vector3d origin = T_CW * s.origin_W, u = T_CW.R * s.u_W, v = T_CW.R * s.v_W, normal = T_CW.R * s.normal_W();
	const double offset = normal.dot(origin);
	if (std::abs(offset) < 1e-9 || (offset > 0 && !s.two_sided)) return std::nullopt;
	int count = 0;
	const auto corners =
	    cutAtNearPlane({origin, origin + s.width_m * u, origin + s.width_m * u + s.height_m * v, origin + s.height_m * v}, count);
	if (count < 3) return std::nullopt;

	SurfaceView view{};
	view.surface = index;
	view.front = offset < 0;
	const Vector3d q = normal / offset;
	view.q = affine(q);
	view.uq = affine(u - u.dot(origin) * q);
	view.vq = affine(v - v.dot(origin) * q);
	view.width = static_cast<float>(s.width_m);
	view.height = static_cast<float>(s.height_m);
	view.corners = count;
	for (size_t i = 0; i < static_cast<size_t>(count); ++i)
	{
		view.outline_x[i] = static_cast<float>(corners[i].x() / corners[i].z());
		view.outline_y[i] = static_cast<float>(corners[i].y() / corners[i].z());
		view.max_q = std::max(view.max_q, static_cast<float>(1 / corners[i].z()));
	}
	const auto [low_x, high_x] = std::minmax_element(view.outline_x.begin(), view.outline_x.begin() + count);
	const auto [low_y, high_y] = std::minmax_element(view.outline_y.begin(), view.outline_y.begin() + count);
	view.low_x = *low_x;
	view.high_x = *high_x;
	view.low_y = *low_y;
	view.high_y = *high_y;
	constexpr double kThin_px = 2;
	view.thin = narrowness_px(view, focal_px) < kThin_px;
	return view;
}

bool mayCover(const SurfaceView& view, const LensTable::Tile& tile)
{
	if (view.high_x < tile.low_x || view.low_x > tile.high_x || view.high_y < tile.low_y || view.low_y > tile.high_y) return false;
	// Separating axis theorem, with the outline's sides; y points down, so that a front winds negatively.
	for (int i = 0; i < view.corners; ++i)
	{
		const auto a = static_cast<size_t>(i), b = static_cast<size_t>((i + 1) % view.corners);
		const float ax = view.outline_x[a], ay = view.outline_y[a], dx = view.outline_x[b] - ax, dy = view.outline_y[b] - ay;
		const float by_y0 = dx * (tile.low_y - ay), by_y1 = dx * (tile.high_y - ay), by_x0 = dy * (tile.low_x - ax),
		            by_x1 = dy * (tile.high_x - ax);
		const float low = std::min(by_y0, by_y1) - std::max(by_x0, by_x1), high = std::max(by_y0, by_y1) - std::min(by_x0, by_x1);
		if (view.front ? low > 0 : high < 0) return false;
	}
	return true;
}
}  // namespace viwo::sim
