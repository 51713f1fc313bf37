#include "PointIndex.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace viwo::gt
{
namespace
{
constexpr int kMaxBuckets = 4'000'000;
}

void PointIndex::build(const Cloud& points, double cell_m)
{
	points_.clear();
	Eigen::Vector2d max = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
	min_ = -max;
	size_t count = 0;
	for (const OrientedPoint& point : points)
		if (point.hasNormal())
		{
			min_ = min_.cwiseMin(point.p);
			max = max.cwiseMax(point.p);
			++count;
		}
	if (count == 0)
	{
		columns_ = rows_ = 0;
		return;
	}
	// A far outlier must not blow the grid up.
	const Eigen::Vector2d span = max - min_;
	while ((span.x() / cell_m + 1) * (span.y() / cell_m + 1) > kMaxBuckets) cell_m *= 2;
	inverse_cell_ = 1 / cell_m;
	columns_ = column(max.x()) + 1;
	rows_ = row(max.y()) + 1;

	begin_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_) + 1, 0);
	bucket_of_.clear();
	for (const OrientedPoint& point : points)
	{
		if (!point.hasNormal()) continue;
		const int bucket = row(point.p.y()) * columns_ + column(point.p.x());
		bucket_of_.push_back(bucket);
		++begin_[static_cast<size_t>(bucket) + 1];
	}
	for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
	points_.resize(count);
	size_t i = 0;
	for (const OrientedPoint& point : points)
		if (point.hasNormal()) points_[static_cast<size_t>(begin_[static_cast<size_t>(bucket_of_[i++])]++)] = point;
	for (size_t b = begin_.size() - 1; b > 0; --b) begin_[b] = begin_[b - 1];
	begin_[0] = 0;
}

const OrientedPoint* PointIndex::nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& n, double radius_m) const
{
	const int c0 = std::max(0, column(p.x() - radius_m)), c1 = std::min(columns_ - 1, column(p.x() + radius_m));
	const int r0 = std::max(0, row(p.y() - radius_m)), r1 = std::min(rows_ - 1, row(p.y() + radius_m));
	const bool any = n.x() == 0 && n.y() == 0;
	double best = radius_m * radius_m;
	const OrientedPoint* found = nullptr;
	for (int r = r0; r <= r1; ++r)
	{
		if (c0 > c1) break;
		const size_t base = static_cast<size_t>(r) * static_cast<size_t>(columns_);
		const int end = begin_[base + static_cast<size_t>(c1) + 1];
		for (int i = begin_[base + static_cast<size_t>(c0)]; i < end; ++i)
		{
			const OrientedPoint& q = points_[static_cast<size_t>(i)];
			const double dx = q.p.x() - p.x(), dy = q.p.y() - p.y();
			const double d = dx * dx + dy * dy;
			if (d >= best || (!any && q.n.x() * n.x() + q.n.y() * n.y() < 0.5)) continue;
			best = d;
			found = &q;
		}
	}
	return found;
}

Cloud thinned(const Cloud& points, double voxel_m)
{
	struct Item
	{
		int64_t x, y;
		int direction;
		size_t index;
	};
	std::vector<Item> items;
	items.reserve(points.size());
	for (size_t i = 0; i < points.size(); ++i)
	{
		const OrientedPoint& point = points[i];
		if (!point.hasNormal()) continue;
		const int direction = static_cast<int>(std::lround((std::atan2(point.n.y(), point.n.x()) + M_PI) * 2 / M_PI)) % 4;
		items.push_back({static_cast<int64_t>(std::floor(point.p.x() / voxel_m)), static_cast<int64_t>(std::floor(point.p.y() / voxel_m)),
		                 direction, i});
	}
	std::sort(items.begin(), items.end(),
	          [](const Item& a, const Item& b)
	          {
		          if (a.x != b.x) return a.x < b.x;
		          if (a.y != b.y) return a.y < b.y;
		          return a.direction != b.direction ? a.direction < b.direction : a.index < b.index;
	          });
	Cloud out;
	for (size_t i = 0; i < items.size();)
	{
		OrientedPoint mean;
		double count = 0;
		const Item& first = items[i];
		for (; i < items.size() && items[i].x == first.x && items[i].y == first.y && items[i].direction == first.direction; ++i)
		{
			mean.p += points[items[i].index].p;
			mean.n += points[items[i].index].n;
			++count;
		}
		mean.p /= count;
		mean.n.normalize();
		out.push_back(mean);
	}
	return out;
}
}  // namespace viwo::gt
