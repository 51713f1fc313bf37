#pragma once

#include <viwo/sim/World.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace viwo::sim
{
/** Bounding-volume hierarchy over rectangles; finds what a ray meets first. Ties go to the lower index, whatever the tree looks like. */
class RectangleTree
{
   public:
	explicit RectangleTree(const std::vector<Surface>& surfaces);

	struct Crossing
	{
		double distance_m;
		size_t surface;
		double u_m, v_m;
	};
	std::optional<Crossing> first(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double max_range_m) const;

   private:
	struct Node
	{
		Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
		size_t begin = 0, end = 0;   // of order_, for a leaf
		size_t left = 0, right = 0;  // right == 0: a leaf
	};
	struct Rectangle
	{
		Eigen::Vector3d origin, u, v, normal;
		double width, height;
		bool two_sided;
	};
	size_t build(size_t begin, size_t end);
	void testRectangle(size_t index, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, std::optional<Crossing>& best,
	                   double& range) const;

	std::vector<Rectangle> rectangles_;
	std::vector<size_t> order_;
	std::vector<Node> nodes_;
};
}  // namespace viwo::sim
