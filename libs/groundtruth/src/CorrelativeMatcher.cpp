#include "CorrelativeMatcher.h"

#include <viwo/core/Ranking.h>

#include <algorithm>
#include <limits>

namespace viwo::gt
{
CorrelativeMatcher::CorrelativeMatcher(const Cloud& map, double resolution_m, double sigma_m) : resolution_m_(resolution_m)
{
	fillField(map, sigma_m);
	for (int level = 1; level < kLevels; ++level) levels_.push_back(coarser(levels_.back(), 1 << (level - 1)));
}

void CorrelativeMatcher::fillField(const Cloud& map, double sigma_m)
{
	Eigen::Vector2d max = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
	min_ = -max;
	for (const OrientedPoint& point : map)
	{
		min_ = min_.cwiseMin(point.p);
		max = max.cwiseMax(point.p);
	}
	const int reach = static_cast<int>(std::ceil(3 * sigma_m / resolution_m_));
	Level field;
	if (!map.empty())
	{
		min_.array() -= reach * resolution_m_;
		max.array() += reach * resolution_m_;
		field.columns = static_cast<int>((max.x() - min_.x()) / resolution_m_) + 1;
		field.rows = static_cast<int>((max.y() - min_.y()) / resolution_m_) + 1;
	}
	field.cells.assign(static_cast<size_t>(field.columns) * static_cast<size_t>(field.rows), 0);
	for (const OrientedPoint& point : map)
	{
		const Eigen::Vector2d cell = (point.p - min_) / resolution_m_;
		const int cx = static_cast<int>(cell.x()), cy = static_cast<int>(cell.y());
		for (int y = std::max(0, cy - reach); y <= std::min(field.rows - 1, cy + reach); ++y)
			for (int x = std::max(0, cx - reach); x <= std::min(field.columns - 1, cx + reach); ++x)
			{
				const double d2 = (Eigen::Vector2d(x + 0.5, y + 0.5) - cell).squaredNorm() * resolution_m_ * resolution_m_;
				const auto value = static_cast<uint8_t>(255 * std::exp(-0.5 * d2 / (sigma_m * sigma_m)));
				uint8_t& target = field.cells[static_cast<size_t>(y) * static_cast<size_t>(field.columns) + static_cast<size_t>(x)];
				target = std::max(target, value);
			}
	}
	levels_.push_back(std::move(field));
}

/** The maximum over twice as many cells: of four cells of the level below, `step` apart. */
CorrelativeMatcher::Level CorrelativeMatcher::coarser(const Level& fine, int step)
{
	Level level;
	level.margin = fine.margin + step;
	level.columns = fine.columns + step;
	level.rows = fine.rows + step;
	level.cells.resize(static_cast<size_t>(level.columns) * static_cast<size_t>(level.rows));
	size_t i = 0;
	for (int y = -level.margin; y < level.rows - level.margin; ++y)
		for (int x = -level.margin; x < level.columns - level.margin; ++x)
			level.cells[i++] = static_cast<uint8_t>(
			    std::max(std::max(fine.at(x, y), fine.at(x + step, y)), std::max(fine.at(x, y + step), fine.at(x + step, y + step))));
	return level;
}

/** One search: the cloud in cells, once for each rotation. */
struct CorrelativeMatcher::Search
{
	const CorrelativeMatcher& matcher;
	std::vector<double> yaw;
	std::vector<std::vector<Eigen::Vector2i>> points;
	int half_cells = 0;
	Candidate best{-1, 0, 0, 0};

	int sum(int level, const Candidate& c) const
	{
		const Level& grid = matcher.levels_[static_cast<size_t>(level)];
		int total = 0;
		for (const Eigen::Vector2i& p : points[static_cast<size_t>(c.rotation)]) total += grid.at(p.x() + c.x, p.y() + c.y);
		return total;
	}

	static bool better(const Candidate& a, const Candidate& b)
	{
		if (a.sum != b.sum) return a.sum > b.sum;
		if (a.rotation != b.rotation) return a.rotation < b.rotation;
		return a.x != b.x ? a.x < b.x : a.y < b.y;
	}

	std::vector<Candidate> coarsest() const
	{
		std::vector<Candidate> candidates;
		const int step = 1 << (kLevels - 1);
		for (int r = 0; r < static_cast<int>(yaw.size()); ++r)
			for (int x = -half_cells; x <= half_cells; x += step)
				for (int y = -half_cells; y <= half_cells; y += step)
				{
					candidates.push_back({r, x, y, 0});
					candidates.back().sum = sum(kLevels - 1, candidates.back());
				}
		std::sort(candidates.begin(), candidates.end(), better);
		return candidates;
	}

	void descend(int level, const std::vector<Candidate>& candidates)
	{
		for (const Candidate& c : candidates)
		{
			if (c.sum <= best.sum) return;
			if (level == 0)
			{
				best = c;
				return;
			}
			const int step = 1 << (level - 1);
			std::vector<Candidate> finer;
			for (const int dx : {0, step})
				for (const int dy : {0, step})
				{
					if (c.x + dx > half_cells || c.y + dy > half_cells) continue;
					finer.push_back({c.rotation, c.x + dx, c.y + dy, 0});
					finer.back().sum = sum(level - 1, finer.back());
				}
			std::sort(finer.begin(), finer.end(), better);
			descend(level - 1, finer);
		}
	}
};

std::optional<CorrelativeMatcher::Match> CorrelativeMatcher::search(const Cloud& cloud, const Pose2& T_centre, double half_width_m,
                                                                    double half_angle_rad, double min_score) const
{
	if (cloud.empty() || levels_.front().cells.empty()) return std::nullopt;
	std::vector<double> ranges_m;
	for (const OrientedPoint& point : cloud) ranges_m.push_back(point.p.norm());
	const double far_m = valueAtRank(ranges_m, ranges_m.size() * 9 / 10);
	const double angle_step = resolution_m_ / std::max(far_m, resolution_m_);

	Search search{*this, {}, {}, static_cast<int>(std::ceil(half_width_m / resolution_m_)), {}};
	const int half_steps = static_cast<int>(std::ceil(half_angle_rad / angle_step));
	for (int r = -half_steps; r <= half_steps; ++r)
	{
		search.yaw.push_back(T_centre.yaw + r * angle_step);
		const Pose2 T(T_centre.p - min_, search.yaw.back());
		const Eigen::Matrix2d R = T.R();
		std::vector<Eigen::Vector2i> cells;
		for (const OrientedPoint& point : cloud)
		{
			const Eigen::Vector2d cell = (R * point.p + T.p) / resolution_m_;
			cells.emplace_back(static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y())));
		}
		search.points.push_back(std::move(cells));
	}
	search.best = {-1, 0, 0, static_cast<int>(min_score * 255 * static_cast<double>(cloud.size()))};
	search.descend(kLevels - 1, search.coarsest());
	if (search.best.rotation < 0) return std::nullopt;
	const Candidate& best = search.best;
	return Match{{T_centre.p + resolution_m_ * Eigen::Vector2d(best.x, best.y), wrapped(search.yaw[static_cast<size_t>(best.rotation)])},
	             best.sum / (255.0 * static_cast<double>(cloud.size()))};
}
}  // namespace viwo::gt
