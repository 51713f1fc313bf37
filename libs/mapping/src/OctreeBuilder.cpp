#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <viwo/core/Error.h>
#include <viwo/core/ParallelFor.h>
#include <viwo/mapping/OctreeBuilder.h>

#include <algorithm>
#include <future>
#include <limits>
#include <optional>

#include "BatchInsertion.h"
#include "CellUpdates.h"

namespace viwo
{
namespace
{
constexpr size_t kScansOfBatch = 64;
static_assert(kScansOfBatch <= kMaxScansOfBatch);
constexpr size_t kRaysOfBatch = 200000;

void check(double resolution_m, const SensorModel& m)
{
	if (!(resolution_m > 0)) throw Error("the resolution of an octree must be above 0 m");
	if (!(m.hit > 0.5 && m.hit < 1)) throw Error("sensor model: hit must lie above 0.5 and below 1");
	if (!(m.miss > 0 && m.miss < 0.5)) throw Error("sensor model: miss must lie above 0 and below 0.5");
	if (!(m.clamping_min > 0 && m.clamping_min < 0.5 && m.clamping_max > 0.5 && m.clamping_max < 1))
		throw Error("sensor model: the clamping limits must lie between 0 and 0.5, and between 0.5 and 1");
	if (!(m.occupancy_threshold > 0 && m.occupancy_threshold < 1))
		throw Error("sensor model: the occupancy threshold must lie between 0 and 1");
}

struct Batch
{
	std::vector<RayScan> scans;
	std::vector<CellUpdate> updates;  //!< sorted
	size_t unusable = 0;
};

void integrateColours(octomap::OcTree&, const Batch&, const RayCasting&) {}

/** Colours of what was hit, as OctoMap averages them, in the order of scans and rays. */
void integrateColours(octomap::ColorOcTree& tree, const Batch& batch, const RayCasting& casting)
{
	const double farthest_m = casting.max_range_m < 0 ? std::numeric_limits<double>::max() : casting.max_range_m;
	for (const RayScan& scan : batch.scans)
		for (size_t i = 0; i < scan.colours.size(); ++i)
		{
			const Ray& ray = scan.hits[i];
			const RayColour& c = scan.colours[i];
			octomap::OcTreeKey key;
			if (!((ray.end - ray.origin).norm() <= farthest_m) || !tree.coordToKeyChecked(ray.end, key)) continue;
			tree.integrateNodeColor(key, c[0], c[1], c[2]);
		}
}
}  // namespace

template <class Tree>
struct OctreeBuilder<Tree>::Impl
{
	Impl(double resolution_m, const RayCasting& casting, int thread_count)
	    : tree(resolution_m),
	      geometry(resolution_m),
	      rays(casting),
	      threads(std::max(1, thread_count)),
	      scratch(static_cast<size_t>(std::max(1, threads - 1)))
	{
	}

	/** Each worker takes every n-th scan; the sort makes the result independent of n. */
	Batch withUpdates(Batch batch)
	{
		const size_t workers = scratch.size();
		std::vector<std::vector<CellUpdate>> parts(workers);
		std::vector<size_t> unusable(workers, 0);
		parallelFor(workers, static_cast<int>(workers),
		            [&](size_t w)
		            {
			            for (size_t i = w; i < batch.scans.size(); i += workers)
				            unusable[w] += appendUpdates(batch.scans[i], i, geometry, rays, scratch[w], parts[w]);
		            });
		for (size_t w = 0; w < workers; ++w)
		{
			batch.updates.insert(batch.updates.end(), parts[w].begin(), parts[w].end());
			batch.unusable += unusable[w];
		}
		std::sort(batch.updates.begin(), batch.updates.end());
		return batch;
	}

	void insert(const Batch& batch)
	{
		BatchInsertion<Tree>(tree, batch.updates).run();
		integrateColours(tree, batch, rays);
		unusable += batch.unusable;
	}

	/** Starts on what has gathered, and inserts what was computed meanwhile. */
	void turnOver()
	{
		Batch next;
		std::swap(next, gathering);
		gathered_rays = 0;
		if (threads == 1)
		{
			insert(withUpdates(std::move(next)));
			return;
		}
		std::optional<Batch> done = computed();
		computing = std::async(std::launch::async, [this, batch = std::move(next)]() mutable { return withUpdates(std::move(batch)); });
		if (done) insert(*done);
	}

	std::optional<Batch> computed()
	{
		if (!computing.valid()) return std::nullopt;
		return computing.get();
	}

	Tree tree;
	const octomap::OcTree geometry;
	const RayCasting rays;
	const int threads;
	std::vector<CellScratch> scratch;  //!< of the batch that is being computed, one a worker
	Batch gathering;
	size_t gathered_rays = 0, unusable = 0;
	std::future<Batch> computing;
};

template <class Tree>
OctreeBuilder<Tree>::OctreeBuilder(double resolution_m, const SensorModel& model, const RayCasting& rays, int threads)
{
	check(resolution_m, model);
	impl_ = std::make_unique<Impl>(resolution_m, rays, threads);
	Tree& tree = impl_->tree;
	tree.setProbHit(model.hit);
	tree.setProbMiss(model.miss);
	tree.setClampingThresMin(model.clamping_min);
	tree.setClampingThresMax(model.clamping_max);
	tree.setOccupancyThres(model.occupancy_threshold);
}

template <class Tree>
OctreeBuilder<Tree>::~OctreeBuilder() = default;

template <class Tree>
void OctreeBuilder<Tree>::add(RayScan scan)
{
	impl_->gathered_rays += scan.hits.size() + scan.clearing.size();
	impl_->gathering.scans.push_back(std::move(scan));
	if (impl_->gathering.scans.size() >= kScansOfBatch || impl_->gathered_rays >= kRaysOfBatch) impl_->turnOver();
}

template <class Tree>
void OctreeBuilder<Tree>::finish()
{
	impl_->turnOver();
	if (const std::optional<Batch> last = impl_->computed()) impl_->insert(*last);
	impl_->tree.updateInnerOccupancy();
}

template <class Tree>
Tree& OctreeBuilder<Tree>::tree()
{
	return impl_->tree;
}

template <class Tree>
size_t OctreeBuilder<Tree>::unusableRays() const
{
	return impl_->unusable;
}

template class OctreeBuilder<octomap::OcTree>;
template class OctreeBuilder<octomap::ColorOcTree>;
}  // namespace viwo
