#include "Refinement.h"

#include <viwo/core/Error.h>
#include <viwo/core/ParallelFor.h>

#include <algorithm>
#include <cstdlib>

namespace viwo::gt
{
namespace
{
constexpr double kKernel = 3;
constexpr int kFewestInliers = 25;
constexpr double kMinRatio = 0.35;
constexpr double kOpenStep_m = 0.1;
constexpr size_t kInTime = 12;  // keys apart at most
constexpr int kFewTies = 5;
constexpr double kWeakLink = 300;
constexpr double kStep_m = 0.12, kStep_rad = 0.05;
constexpr double kPresent2 = 0.2 * 0.2, kPresentYaw2 = 0.05 * 0.05;  // m^2, rad^2

struct Near
{
	double cost;
	size_t key;
};

/** Earlier keys that a key is registered with: the last few, and the nearest of former visits, spread over visits. */
std::vector<size_t> partners(const KeyScans& keys, size_t k, const GraphOptions& options, double factor)
{
	std::vector<size_t> chosen;
	const size_t wanted = static_cast<size_t>(factor * options.neighbours);
	for (const size_t back : {1, 2, 3, 5, 8, 12})
		if (back <= k && chosen.size() < wanted) chosen.push_back(k - back);
	std::vector<Near> near;
	for (size_t j = 0; j + 12 < k; ++j)
	{
		const double distance_m = (keys.poses[j].p - keys.poses[k].p).norm();
		if (distance_m > factor * options.neighbour_distance_m) continue;
		near.push_back({distance_m + 0.5 * std::abs(wrapped(keys.poses[j].yaw - keys.poses[k].yaw)), j});
	}
	std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.cost != b.cost ? a.cost < b.cost : a.key < b.key; });
	for (const Near& candidate : near)
	{
		if (chosen.size() >= wanted) break;
		const bool fresh =
		    std::none_of(chosen.begin(), chosen.end(),
		                 [&](size_t j) { return std::llabs(static_cast<long long>(j) - static_cast<long long>(candidate.key)) < 4; });
		if (fresh) chosen.push_back(candidate.key);
	}
	return chosen;
}

/** Registrations of key k with its partners. */
std::vector<GraphEdge> registered(const KeyScans& keys, size_t k, const GroundTruthOptions& options, const Scales& scales, bool first_round)
{
	std::vector<GraphEdge> edges;
	PointIndex index;
	RegistrationOptions registration = scales.registration;
	if (!first_round) registration.first_radius_m = registration.last_radius_m;
	index.build(keys.clouds[k], 2.5 * scales.voxel_m);
	for (const size_t j : partners(keys, k, options.graph, scales.partners))
	{
		// The graph's pose holds directions that the two scans leave open; it does not count in the information.
		const PosePrior present{between(keys.poses[k], keys.poses[j]),
		                        Eigen::Vector3d(1 / kPresent2, 1 / kPresent2, 1 / kPresentYaw2).asDiagonal()};
		const Registration r = registerCloud(keys.clouds[j], index, present.T, &present, registration);
		if (r.inliers < kFewestInliers || r.inlierRatio() < kMinRatio) continue;
		// Neighbours in time are known well from tracking: who leaves that has followed leaves or passers-by.
		const Pose2 step = between(present.T, r.T);
		const bool in_time = k - j <= kInTime;
		if (in_time && (step.p.norm() > kStep_m || std::abs(step.yaw) > kStep_rad)) continue;
		GraphEdge edge;
		edge.a = k;
		edge.b = j;
		edge.T_ab = r.T;
		// What little faces along a corridor is no reason for a step that odometry knows nothing of.
		const bool stepped = std::abs(r.weakest_direction.dot(r.T.p - present.T.p)) > kOpenStep_m;
		const double trust = r.trust(options.matching.min_weakest);
		edge.information =
		    r.trustedInformation(trust < 1 && stepped ? 0 : trust) / options.graph.inflation + 1e-6 * Eigen::Matrix3d::Identity();
		edge.kind = in_time ? GraphEdge::Kind::scan : GraphEdge::Kind::loop;
		edge.kernel = kKernel;
		edges.push_back(edge);
	}
	return edges;
}

/** Where few pairs tie a key scan to the next in all directions, what tracking has found, against a whole local map, holds them together: a
 *  weak link would take all that loops have to correct. */
void strengthenWeakLinks(const std::vector<std::vector<GraphEdge>>& found, std::vector<GraphEdge>& edges)
{
	std::vector<int> ties(found.size(), 0);  // of each key with the next
	for (const auto& of_key : found)
		for (const GraphEdge& edge : of_key)
			if (edge.kind == GraphEdge::Kind::scan && holdsAllDirections(edge))
				for (size_t k = std::min(edge.a, edge.b); k < std::max(edge.a, edge.b); ++k) ++ties[k];
	for (GraphEdge& edge : edges)
		if (edge.kind == GraphEdge::Kind::scan && ties[std::min(edge.a, edge.b)] < kFewTies) edge.information *= kWeakLink;
}

}  // namespace

std::vector<GraphEdge> refineKeys(KeyScans& keys, const std::vector<GraphEdge>& kept, GyroTurns& gyro, const GroundTruthOptions& options,
                                  const Scales& scales, int threads, const std::function<bool(double)>& proceed)
{
	std::vector<GraphEdge> edges;
	for (int round = 0; round < options.graph.rounds; ++round)
	{
		if (!proceed(static_cast<double>(round) / options.graph.rounds)) throw Error("interrupted: nothing was written");
		std::vector<std::vector<GraphEdge>> found(keys.size());
		parallelFor(keys.size(), threads, [&](size_t k) { found[k] = registered(keys, k, options, scales, round == 0); });
		edges = kept;
		strengthenWeakLinks(found, edges);
		for (const auto& of_key : found) edges.insert(edges.end(), of_key.begin(), of_key.end());
		optimizeGraph(edges, keys.poses, 20, &gyro);
	}
	return edges;
}
}  // namespace viwo::gt
