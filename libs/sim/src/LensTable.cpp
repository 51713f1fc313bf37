#include "LensTable.h"

#include <viwo/core/Error.h>

#include <algorithm>

namespace viwo::sim
{
namespace
{
Eigen::Vector2d normalised(const CameraModel& camera, double x_px, double y_px)
{
	constexpr double kMinCosine = 0.07;
	const Eigen::Vector3d ray = camera.unproject({x_px, y_px});
	if (!(ray.z() > kMinCosine))
		throw Error("renderer: the camera model looks more than 86 deg off its axis at pixel " + std::to_string(x_px) + ", " +
		            std::to_string(y_px) + ": use a longer focal length or a smaller image");
	return ray.head<2>() / ray.z();
}
}  // namespace

LensTable::LensTable(const CameraModel& camera)
{
	if (camera.width_px() <= 0 || camera.height_px() <= 0 || !(camera.fx_px() > 0) || !(camera.fy_px() > 0))
		throw Error("renderer: the camera has no size or no focal length: give its calibration");
	for (int y = 0; y < camera.height_px(); y += kTile_px)
		for (int x = 0; x < camera.width_px(); x += kTile_px) addTile(camera, x, y);
}

void LensTable::addTile(const CameraModel& camera, int x_px, int y_px)
{
	Tile tile{};
	tile.x_px = x_px;
	tile.y_px = y_px;
	tile.columns = std::min(kTile_px, camera.width_px() - x_px);
	tile.rows = std::min(kTile_px, camera.height_px() - y_px);
	tile.first = x_.size();
	for (int y = 0; y < kTile_px; ++y)
		for (int x = 0; x < kTile_px; ++x)
		{
			// Beyond the image's rim the last pixel is repeated, so that all tiles are whole.
			const Eigen::Vector2d ray = normalised(camera, x_px + std::min(x, tile.columns - 1), y_px + std::min(y, tile.rows - 1));
			x_.push_back(static_cast<float>(ray.x()));
			y_.push_back(static_cast<float>(ray.y()));
		}
	const double middle_x = x_px + 0.5 * (tile.columns - 1), middle_y = y_px + 0.5 * (tile.rows - 1);
	const Eigen::Vector2d right = normalised(camera, middle_x + 0.5, middle_y) - normalised(camera, middle_x - 0.5, middle_y);
	const Eigen::Vector2d down = normalised(camera, middle_x, middle_y + 0.5) - normalised(camera, middle_x, middle_y - 0.5);
	tile.x_px_x = static_cast<float>(right.x());
	tile.x_px_y = static_cast<float>(right.y());
	tile.y_px_x = static_cast<float>(down.x());
	tile.y_px_y = static_cast<float>(down.y());

	const auto begin = static_cast<std::ptrdiff_t>(tile.first);
	const auto [min_x, max_x] = std::minmax_element(x_.begin() + begin, x_.end());
	const auto [min_y, max_y] = std::minmax_element(y_.begin() + begin, y_.end());
	const float half_pixel_x = std::abs(tile.x_px_x) + std::abs(tile.y_px_x), half_pixel_y = std::abs(tile.x_px_y) + std::abs(tile.y_px_y);
	tile.low_x = *min_x - half_pixel_x;
	tile.high_x = *max_x + half_pixel_x;
	tile.low_y = *min_y - half_pixel_y;
	tile.high_y = *max_y + half_pixel_y;
	tiles_.push_back(tile);
}
}  // namespace viwo::sim
