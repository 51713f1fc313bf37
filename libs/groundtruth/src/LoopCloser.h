#pragma once

#include "KeyScans.h"

#include <map>

namespace viwo::gt
{
struct LoopCounts
{
	size_t searched = 0;  //!< pairs of submaps that were compared
	size_t matched = 0;   //!< of these, that lay well on each other
	size_t accepted = 0;
	size_t rejected = 0;     //!< contradicted by the optimised graph, those made by hand included
	size_t unconfirmed = 0;  //!< no second loop told of the same correction
};

/** Finds places that were seen before and ties them together.
 *
 *  Candidates are submaps whose distance the drift of the graph between them could explain. Each is compared by correlation over the whole
 * window of that uncertainty, refined point to line, and held back until a second loop nearby tells of the same correction; all enter the
 * graph with a robust kernel, and leave it if the optimised graph disagrees.
 */
class LoopCloser
{
   public:
	LoopCloser(KeyScans& keys, std::vector<GraphEdge>& edges, const GroundTruthOptions& options, const Scales& scales);

	/** Over all submaps in the order of time. Moves the keys' poses, appends to the edges. */
	LoopCounts close(int threads, const std::function<bool(double)>& proceed);

   private:
	struct Candidate
	{
		size_t key;
		double half_width_m, half_angle_rad, distance_m;
	};
	struct Loop
	{
		GraphEdge edge;
		bool small = false;  //!< within what a short way of drift explains
	};

	std::vector<double> graphDistances(size_t from) const;
	std::vector<Candidate> candidates(size_t submap) const;
	Cloud submapCloud(size_t key, double reach_m) const;
	const CorrelativeMatcher& matcherOf(size_t key);
	std::optional<Loop> compare(const Cloud& query, size_t key, const Candidate& candidate, const CorrelativeMatcher& matcher) const;
	bool agree(const GraphEdge& a, const GraphEdge& b) const;
	std::vector<Loop> compareAll(size_t submap, int threads, LoopCounts& counts);
	void closeOneByOne(int threads, const std::function<bool(double)>& proceed, LoopCounts& counts);
	/** Where no loop was sure by itself: those of a wider window and lower limits vote on the correction. @return whether there is a clear
	 * winner. */
	bool closeByVote(int threads, LoopCounts& counts);
	std::vector<size_t> votersFor(const Loop& one, const std::vector<Loop>& loops) const;
	void consider(const Loop& loop, LoopCounts& counts);
	void accept(const GraphEdge& edge, LoopCounts& counts);
	void removeOutliers(LoopCounts& counts);

	KeyScans& keys_;
	std::vector<GraphEdge>& edges_;
	const GroundTruthOptions& options_;
	const Scales& scales_;
	LoopOptions limits_;
	std::vector<size_t> submaps_;                                //!< central key of each
	std::vector<std::vector<std::pair<size_t, double>>> links_;  //!< of the graph, with lengths
	std::map<size_t, CorrelativeMatcher> matchers_;
	std::vector<GraphEdge> pending_;
	bool moved_ = false;
};
}  // namespace viwo::gt
