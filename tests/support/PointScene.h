#pragma once

#include <viwo/core/FeatureFrame.h>
#include <viwo/core/Pose3.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace viwo::test
{
/** Landmarks in the world, and what a camera sees of them: bearings within half_angle_rad of its axis, at 0.3 to max_range_m, with noise
 * and false ones. */
class PointScene
{
   public:
	struct Noise
	{
		double sigma_rad = 0;
		double outlier_share = 0;  //!< of the landmarks: their bearings are off by up to 0.15 rad in every frame
		uint64_t seed = 1;
	};

	/** Points in a box, none nearer than clear_m to its centre line along x. */
	PointScene(const Eigen::Vector3d& min_W, const Eigen::Vector3d& max_W, int count, double clear_m, uint64_t seed)
	{
		std::mt19937_64 generator(seed);
		std::uniform_real_distribution<double> unit(0, 1);
		while (static_cast<int>(points_W.size()) < count)
		{
			const Eigen::Vector3d s(unit(generator), unit(generator), unit(generator));
			const Eigen::Vector3d P = min_W + s.cwiseProduct(max_W - min_W);
			if (P.tail<2>().norm() > clear_m) points_W.push_back(P);
		}
	}

	FeatureFrame observe(int64_t t_ns, const Pose3& T_WC, const Noise& noise, double max_range_m = 12, double half_angle_rad = 0.85) const
	{
		std::mt19937_64 generator(noise.seed + static_cast<uint64_t>(t_ns));
		std::normal_distribution<double> normal(0, 1);
		std::uniform_real_distribution<double> uniform(-0.15, 0.15);
		FeatureFrame frame;
		frame.t_ns = t_ns;
		for (size_t i = 0; i < points_W.size(); ++i)
		{
			const Eigen::Vector3d P_C = T_WC.inverse() * points_W[i];
			Eigen::Vector3d bearing = P_C.normalized();
			Eigen::Vector3d error(normal(generator), normal(generator), normal(generator));
			error *= noise.sigma_rad;
			const Eigen::Vector3d off(uniform(generator), uniform(generator), 0);
			if (static_cast<double>(i % 100) < 100 * noise.outlier_share) error += off;
			if (P_C.norm() > max_range_m || P_C.norm() < 0.3 || bearing.z() < std::cos(half_angle_rad)) continue;
			bearing = (bearing + error - bearing * bearing.dot(error)).normalized();
			frame.features.push_back({i, Eigen::Vector2d::Zero(), bearing});
		}
		return frame;
	}

	std::vector<Eigen::Vector3d> points_W;
};
}  // namespace viwo::test
