#include "RectangleTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace viwo::sim
{
namespace
{
constexpr size_t kLeafSize = 4;
// Boxes are grown by this much, so that a flat one is not missed by rounding.
constexpr double kMargin_m = 1e-9;

bool meets(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& origin, const Eigen::Vector3d& inverse,
           double range)
{
	double enter = 0, leave = range;
	for (int i = 0; i < 3; ++i)
	{
		if (std::isinf(inverse[i]))
		{
			if (origin[i] < low[i] || origin[i] > high[i]) return false;
			continue;
		}
		const double a = (low[i] - origin[i]) * inverse[i], b = (high[i] - origin[i]) * inverse[i];
		enter = std::max(enter, std::min(a, b));
		leave = std::min(leave, std::max(a, b));
	}
	return enter <= leave + kMargin_m;
}
}  // namespace

RectangleTree::RectangleTree(const std::vector<Surface>& surfaces) : order_(surfaces.size())
{
	for (const auto& s : surfaces) rectangles_.push_back({s.origin_W, s.u_W, s.v_W, s.normal_W(), s.width_m, s.height_m, s.two_sided});
	std::iota(order_.begin(), order_.end(), size_t{0});
	if (!order_.empty()) build(0, order_.size());
}

size_t RectangleTree::build(size_t begin, size_t end)
{
	const size_t index = nodes_.size();
	nodes_.emplace_back();
	Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
	for (size_t i = begin; i < end; ++i)
	{
		const Rectangle& r = rectangles_[order_[i]];
		for (double u : {0.0, r.width})
			for (double v : {0.0, r.height})
			{
				const Eigen::Vector3d corner = r.origin + u * r.u + v * r.v;
				low = low.cwiseMin(corner);
				high = high.cwiseMax(corner);
			}
	}
	size_t left = 0, right = 0;
	if (end - begin > kLeafSize)
	{
		Eigen::Index axis = 0;
		(high - low).maxCoeff(&axis);
		const auto centre = [&](size_t i)
		{
			const Rectangle& r = rectangles_[i];
			return r.origin[axis] + 0.5 * (r.width * r.u[axis] + r.height * r.v[axis]);
		};
		std::sort(order_.begin() + static_cast<std::ptrdiff_t>(begin), order_.begin() + static_cast<std::ptrdiff_t>(end),
		          [&](size_t a, size_t b) { return centre(a) != centre(b) ? centre(a) < centre(b) : a < b; });
		const size_t middle = begin + (end - begin) / 2;
		left = build(begin, middle);
		right = build(middle, end);
	}
	Node& node = nodes_[index];
	node.low = low.array() - kMargin_m;
	node.high = high.array() + kMargin_m;
	node.begin = begin;
	node.end = end;
	node.left = left;
	node.right = right;
	return index;
}

void RectangleTree::testRectangle(size_t index, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  std::optional<Crossing>& best, double& range) const
{
	const Rectangle& r = rectangles_[index];
	const double slope = r.normal.dot(direction);
	if (slope == 0 || (slope > 0 && !r.two_sided)) return;
	const double distance = r.normal.dot(r.origin - origin) / slope;
	if (!(distance > 0) || distance > range) return;
	if (best && distance == range && index > best->surface) return;
	const Eigen::Vector3d offset = origin + distance * direction - r.origin;
	const double u = offset.dot(r.u), v = offset.dot(r.v);
	// Neighbouring rectangles share their edges: a ray on the seam must meet one of them.
	if (u < -kMargin_m || u > r.width + kMargin_m || v < -kMargin_m || v > r.height + kMargin_m) return;
	best = Crossing{distance, index, std::clamp(u, 0.0, r.width), std::clamp(v, 0.0, r.height)};
	range = distance;
}

std::optional<RectangleTree::Crossing> RectangleTree::first(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
                                                            double max_range_m) const
{
	std::optional<Crossing> best;
	if (nodes_.empty()) return best;
	double range = max_range_m;
	const Eigen::Vector3d inverse = direction_W.cwiseInverse();
	std::array<size_t, 64> stack;
	size_t depth = 0;
	stack[depth++] = 0;
	while (depth > 0)
	{
		const Node& node = nodes_[stack[--depth]];
		if (!meets(node.low, node.high, origin_W, inverse, range)) continue;
		if (node.right != 0)
		{
			stack[depth++] = node.right;
			stack[depth++] = node.left;
			continue;
		}
		for (size_t i = node.begin; i < node.end; ++i) testRectangle(order_[i], origin_W, direction_W, best, range);
	}
	return best;
}
}  // namespace viwo::sim
