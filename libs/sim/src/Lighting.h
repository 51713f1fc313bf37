#pragma once

#include <viwo/sim/World.h>

#include <algorithm>
#include <vector>

namespace viwo::sim
{
/** Light that falls on each surface, computed once: lamps (every surface that emits) with shadows, their light
 *  thrown back once by what is opposite, and ambient light dimmed in nooks.
 *  In units of nominal illumination; a world without lamps is lit evenly with 1.
 */
class Lighting
{
   public:
	explicit Lighting(const World& world);

	float at(size_t surface, float u_m, float v_m) const
	{
		const Grid& g = grids_[surface];
		const float x = std::clamp(u_m * g.nodes_per_u, 0.0f, g.last_x), y = std::clamp(v_m * g.nodes_per_v, 0.0f, g.last_y);
		const int x0 = std::min(static_cast<int>(x), g.columns - 2), y0 = std::min(static_cast<int>(y), g.rows - 2);
		const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
		const float* low = nodes_.data() + g.offset + static_cast<size_t>(y0) * static_cast<size_t>(g.columns) + static_cast<size_t>(x0);
		const float* high = low + g.columns;
		const float a = low[0] + fx * (low[1] - low[0]), b = high[0] + fx * (high[1] - high[0]);
		return a + fy * (b - a);
	}

   private:
	struct Grid
	{
		int columns, rows;  // of nodes, at least 2
		float nodes_per_u, nodes_per_v, last_x, last_y;
		size_t offset;
	};
	static Eigen::Vector3d nodePoint(const Surface& s, const Grid& grid, int node);

	std::vector<Grid> grids_;
	std::vector<float> nodes_;
};
}  // namespace viwo::sim
