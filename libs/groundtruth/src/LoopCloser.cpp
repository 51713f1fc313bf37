#include "LoopCloser.h"

#include <viwo/core/Error.h>
#include <viwo/core/ParallelFor.h>
#include <viwo/core/Scalars.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <set>

namespace viwo::gt
{
namespace
{
constexpr double kLinkLength_m = 0.3;  //!< of a loop, as a way along which the graph drifts
constexpr double kPendingWay_m = 15;   //!< loops this far apart may confirm each other
constexpr double kKernel = 3;
constexpr double kWorstChi2 = 60;
constexpr double kVoteWider = 4, kVoteDrift = 1.8, kVoteScore = 0.3, kVoteInlierRatio = 0.25;
constexpr size_t kVoteQueries = 5;  //!< submaps that must tell of the same correction
}  // namespace

LoopCloser::LoopCloser(KeyScans& keys, std::vector<GraphEdge>& edges, const GroundTruthOptions& options, const Scales& scales)
    : keys_(keys), edges_(edges), options_(options), scales_(scales), limits_(options.loops), links_(keys.size())
{
	for (size_t k = 0; k < keys_.size(); ++k)
	{
		if (k > 0)
		{
			const double length = keys_.way_m[k] - keys_.way_m[k - 1];
			links_[k].emplace_back(k - 1, length);
			links_[k - 1].emplace_back(k, length);
		}
		if (submaps_.empty() || keys_.way_m[k] - keys_.way_m[submaps_.back()] >= options_.loops.submap_m) submaps_.push_back(k);
	}
	for (const GraphEdge& edge : edges_)
		if (edge.kind == GraphEdge::Kind::loop)
		{
			links_[edge.a].emplace_back(edge.b, kLinkLength_m);
			links_[edge.b].emplace_back(edge.a, kLinkLength_m);
		}
}

std::vector<double> LoopCloser::graphDistances(size_t from) const
{
	std::vector<double> distance(keys_.size(), std::numeric_limits<double>::infinity());
	using Entry = std::pair<double, size_t>;
	std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
	distance[from] = 0;
	queue.emplace(0, from);
	while (!queue.empty())
	{
		const auto [d, k] = queue.top();
		queue.pop();
		if (d > distance[k]) continue;
		for (const auto& [next, length] : links_[k])
			if (d + length < distance[next]) queue.emplace(distance[next] = d + length, next);
	}
	return distance;
}

std::vector<LoopCloser::Candidate> LoopCloser::candidates(size_t submap) const
{
	const LoopOptions& o = limits_;
	const size_t key = submaps_[submap];
	const std::vector<double> way = graphDistances(key);
	std::vector<Candidate> found;
	for (size_t s = 0; s < submap; ++s)
	{
		const size_t other = submaps_[s];
		if (way[other] < 2 * o.submap_reach_m) continue;
		Candidate c;
		c.key = other;
		c.half_width_m = std::min(o.max_search_m, 0.3 + o.drift_per_m * way[other]);
		c.half_angle_rad = std::min(o.max_search_deg, 4 + o.drift_deg_per_m * way[other]) * kDegree;
		c.distance_m = (keys_.poses[key].p - keys_.poses[other].p).norm();
		if (c.distance_m < c.half_width_m + 0.5 * o.submap_reach_m) found.push_back(c);
	}
	std::sort(found.begin(), found.end(),
	          [](const Candidate& a, const Candidate& b)
	          { return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.key < b.key; });
	if (found.size() > static_cast<size_t>(o.max_candidates)) found.resize(static_cast<size_t>(o.max_candidates));
	return found;
}

Cloud LoopCloser::submapCloud(size_t key, double reach_m) const
{
	Cloud cloud;
	const auto add = [&](size_t k)
	{
		if (std::abs(keys_.way_m[k] - keys_.way_m[key]) > reach_m) return false;
		appendMoved(between(keys_.poses[key], keys_.poses[k]), keys_.clouds[k], cloud);
		return true;
	};
	for (size_t k = key; k < keys_.size() && add(k); ++k) continue;
	for (size_t k = key; k-- > 0 && add(k);) continue;
	return thinned(cloud, scales_.voxel_m);
}

const CorrelativeMatcher& LoopCloser::matcherOf(size_t key)
{
	const auto known = matchers_.find(key);
	if (known != matchers_.end()) return known->second;
	return matchers_
	    .emplace(key,
	             CorrelativeMatcher(submapCloud(key, limits_.submap_reach_m), 2 * scales_.field_resolution_m, 1.5 * scales_.field_sigma_m))
	    .first->second;
}

std::optional<LoopCloser::Loop> LoopCloser::compare(const Cloud& query, size_t key, const Candidate& candidate,
                                                    const CorrelativeMatcher& matcher) const
{
	const Pose2 T_guess = between(keys_.poses[candidate.key], keys_.poses[key]);
	const Cloud coarse = thinned(query, 2.5 * scales_.voxel_m);
	const auto match = matcher.search(coarse, T_guess, candidate.half_width_m, candidate.half_angle_rad, limits_.min_score);
	if (!match) return std::nullopt;
	PointIndex index;
	index.build(submapCloud(candidate.key, limits_.submap_reach_m), 2 * scales_.voxel_m);
	const Registration r = registerCloud(query, index, match->T, nullptr, scales_.registration);
	const double trust = r.trust(options_.matching.min_weakest);
	if (r.inlierRatio() < limits_.min_inlier_ratio || trust <= 0) return std::nullopt;
	// Refinement that leaves the place it started from has found something else.
	if ((r.T.p - match->T.p).norm() > std::max(0.4, scales_.registration.last_radius_m)) return std::nullopt;
	Loop loop;
	loop.edge.a = candidate.key;
	loop.edge.b = key;
	loop.edge.T_ab = r.T;
	// Points of a submap have been averaged already: they weigh like a few scans at most.
	loop.edge.information = r.trustedInformation(trust) / (options_.graph.inflation * std::max(1.0, r.inliers / 150.0));
	loop.edge.kind = GraphEdge::Kind::loop;
	loop.edge.kernel = kKernel;
	const Pose2 correction = between(T_guess, r.T);
	loop.small = correction.p.norm() < 0.3 && std::abs(correction.yaw) < 2 * kDegree && candidate.half_width_m < 1;
	return loop;
}

/** Two loops agree when one, carried along the path to the other, tells of the same pose. */
bool LoopCloser::agree(const GraphEdge& a, const GraphEdge& b) const
{
	const double way_m = std::abs(keys_.way_m[a.b] - keys_.way_m[b.b]);
	if (way_m > kPendingWay_m) return false;
	const Pose2 by_a = keys_.poses[a.a] * a.T_ab * between(keys_.poses[a.b], keys_.poses[b.b]);
	const Pose2 by_b = keys_.poses[b.a] * b.T_ab;
	const double refs_m = (keys_.poses[a.a].p - keys_.poses[b.a].p).norm();
	const Pose2 d = between(by_a, by_b);
	return d.p.norm() < 0.25 + 0.03 * (way_m + refs_m) && std::abs(d.yaw) < (2.5 + 0.2 * way_m) * kDegree;
}

void LoopCloser::accept(const GraphEdge& edge, LoopCounts& counts)
{
	edges_.push_back(edge);
	links_[edge.a].emplace_back(edge.b, kLinkLength_m);
	links_[edge.b].emplace_back(edge.a, kLinkLength_m);
	++counts.accepted;
	const Pose2 error = between(edge.T_ab, between(keys_.poses[edge.a], keys_.poses[edge.b]));
	if (error.p.norm() > 0.05 || std::abs(error.yaw) > 0.5 * kDegree) moved_ = true;
}

void LoopCloser::consider(const Loop& loop, LoopCounts& counts)
{
	++counts.matched;
	if (loop.small) return accept(loop.edge, counts);
	std::vector<GraphEdge> left;
	bool confirmed = false;
	for (const GraphEdge& other : pending_)
	{
		if (other.b != loop.edge.b && agree(other, loop.edge))
		{
			accept(other, counts);
			confirmed = true;
		}
		else
			left.push_back(other);
	}
	pending_ = std::move(left);
	if (confirmed)
		accept(loop.edge, counts);
	else
		pending_.push_back(loop.edge);
}

void LoopCloser::removeOutliers(LoopCounts& counts)
{
	const auto bad = [&](const GraphEdge& edge) { return edge.kind == GraphEdge::Kind::loop && chi2(edge, keys_.poses) > kWorstChi2; };
	const auto end = std::remove_if(edges_.begin(), edges_.end(), bad);
	const auto removed = static_cast<size_t>(std::distance(end, edges_.end()));
	edges_.erase(end, edges_.end());
	counts.accepted -= std::min(counts.accepted, removed);
	counts.rejected += removed;
	if (removed > 0) optimizeGraph(edges_, keys_.poses, 20);
}

std::vector<LoopCloser::Loop> LoopCloser::compareAll(size_t submap, int threads, LoopCounts& counts)
{
	const std::vector<Candidate> tried = candidates(submap);
	if (tried.empty()) return {};
	const Cloud query = submapCloud(submaps_[submap], limits_.query_reach_m);
	for (const Candidate& c : tried) matcherOf(c.key);
	std::vector<std::optional<Loop>> found(tried.size());
	parallelFor(tried.size(), threads,
	            [&](size_t i) { found[i] = compare(query, submaps_[submap], tried[i], matchers_.at(tried[i].key)); });
	counts.searched += tried.size();
	std::vector<Loop> loops;
	for (const auto& loop : found)
		if (loop) loops.push_back(*loop);
	return loops;
}

void LoopCloser::closeOneByOne(int threads, const std::function<bool(double)>& proceed, LoopCounts& counts)
{
	for (size_t s = 0; s < submaps_.size(); ++s)
	{
		if (!proceed(static_cast<double>(s) / static_cast<double>(submaps_.size()))) throw Error("interrupted: nothing was written");
		for (const Loop& loop : compareAll(s, threads, counts)) consider(loop, counts);
		if (moved_) optimizeGraph(edges_, keys_.poses, 15);
		moved_ = false;
	}
}

std::vector<size_t> LoopCloser::votersFor(const Loop& one, const std::vector<Loop>& loops) const
{
	std::vector<size_t> voters;
	for (size_t i = 0; i < loops.size(); ++i)
		if (agree(one.edge, loops[i].edge)) voters.push_back(i);
	return voters;
}

bool LoopCloser::closeByVote(int threads, LoopCounts& counts)
{
	const LoopOptions usual = limits_;
	limits_.max_search_m *= kVoteWider;
	limits_.drift_per_m *= kVoteDrift;
	limits_.min_score = std::min(usual.min_score, kVoteScore);
	limits_.min_inlier_ratio = std::min(usual.min_inlier_ratio, kVoteInlierRatio);
	limits_.query_reach_m *= 3;
	limits_.submap_reach_m *= 2;
	limits_.max_candidates *= 2;
	matchers_.clear();
	std::vector<Loop> loops;
	for (size_t s = 0; s < submaps_.size(); ++s)
		for (const Loop& loop : compareAll(s, threads, counts)) loops.push_back(loop);
	limits_ = usual;
	matchers_.clear();

	const auto queriesOf = [&loops](const std::vector<size_t>& voters)
	{
		std::set<size_t> queries;
		for (const size_t i : voters) queries.insert(loops[i].edge.b);
		return queries.size();
	};
	std::vector<size_t> elected;
	for (const Loop& loop : loops)
	{
		std::vector<size_t> voters = votersFor(loop, loops);
		if (voters.size() > elected.size()) elected = std::move(voters);
	}
	// Who disagrees with all of the elected must be a small minority.
	std::vector<Loop> others;
	for (size_t i = 0; i < loops.size(); ++i)
		if (std::none_of(elected.begin(), elected.end(), [&](size_t e) { return agree(loops[e].edge, loops[i].edge); }))
			others.push_back(loops[i]);
	size_t opposition = 0;
	for (const Loop& loop : others) opposition = std::max(opposition, votersFor(loop, others).size());
	counts.matched += loops.size();
	if (queriesOf(elected) < kVoteQueries || elected.size() < 2 * opposition) return false;
	for (const size_t i : elected) accept(loops[i].edge, counts);
	optimizeGraph(edges_, keys_.poses, 50);
	return true;
}

LoopCounts LoopCloser::close(int threads, const std::function<bool(double)>& proceed)
{
	LoopCounts counts;
	if (options_.loops.enabled) closeOneByOne(threads, proceed, counts);
	// After a long way the drift may exceed the usual window, and what is seen again may look different from the other lane.
	const bool far = !keys_.way_m.empty() && options_.loops.drift_per_m * keys_.way_m.back() > options_.loops.max_search_m;
	if (options_.loops.enabled && counts.accepted == 0 && far && closeByVote(threads, counts)) closeOneByOne(threads, proceed, counts);
	counts.unconfirmed = pending_.size();
	optimizeGraph(edges_, keys_.poses, 50);
	removeOutliers(counts);
	matchers_.clear();
	return counts;
}
}  // namespace viwo::gt
