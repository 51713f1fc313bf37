#pragma once

#include "OrientedPoint.h"

#include <cstdint>
#include <optional>

namespace viwo::gt
{
/** Searches a whole window of poses for the one where a cloud lies best on a map: correlation with a likelihood field, branch and bound
 * over a pyramid of its maxima (Olson, "Real-time correlative scan matching", ICRA 2009; Hess et al., "Real-time loop closure in 2D LIDAR
 * SLAM", ICRA 2016). The result is the best of the discretised window, not a local one.
 */
class CorrelativeMatcher
{
   public:
	struct Match
	{
		Pose2 T;           //!< cloud in the map
		double score = 0;  //!< mean likelihood of the cloud's points, 0 to 1
	};

	/** @param sigma_m width of the likelihood around the map's points. */
	CorrelativeMatcher(const Cloud& map, double resolution_m, double sigma_m);

	/** @return nothing where no pose of the window scores min_score. */
	std::optional<Match> search(const Cloud& cloud, const Pose2& T_centre, double half_width_m, double half_angle_rad,
	                            double min_score) const;

   private:
	static constexpr int kLevels = 6;
	struct Level
	{
		int columns = 0, rows = 0, margin = 0;  //!< cell (x, y) is at (x + margin, y + margin)
		std::vector<uint8_t> cells;             //!< maximum over 2^level cells to the right and upwards
		int at(int x, int y) const
		{
			x += margin;
			y += margin;
			return x < 0 || y < 0 || x >= columns || y >= rows
			           ? 0
			           : cells[static_cast<size_t>(y) * static_cast<size_t>(columns) + static_cast<size_t>(x)];
		}
	};
	struct Candidate
	{
		int rotation, x, y, sum;
	};
	struct Search;

	void fillField(const Cloud& map, double sigma_m);
	static Level coarser(const Level& fine, int step);

	double resolution_m_;
	Eigen::Vector2d min_ = Eigen::Vector2d::Zero();
	std::vector<Level> levels_;
};
}  // namespace viwo::gt
